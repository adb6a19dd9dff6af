/* SPDX-FileCopyrightText: 2026 the bbsim authors
 * SPDX-License-Identifier: BSD-3-Clause */

/* The C interface between the program and its HDF5 module, which is opened at run time to write
   files. No C++ type and no exception crosses it; each side frees what it allocated. (Files are
   read elsewhere, in a process of their own: table_text.hpp.) */
#ifndef BBSIM_RECORD_HDF5_INTERFACE_H
#define BBSIM_RECORD_HDF5_INTERFACE_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Grows with every change below; program and module refuse each other if theirs differ. */
enum { BBSIM_HDF5_INTERFACE = 4 };

/* Why a call failed: `system_error` is the errno of a failed write, or 0 if `text` tells. */
typedef struct bbsim_hdf5_error {
  int system_error;
  char text[500];
} bbsim_hdf5_error;

/* What a dataset holds. */
typedef enum bbsim_hdf5_kind {
  BBSIM_HDF5_NUMBER,  /* a double a row */
  BBSIM_HDF5_INTEGER, /* a whole number a row: a double here, 64 bits in the file */
  BBSIM_HDF5_TEXT,    /* a string a row */
  BBSIM_HDF5_SERIES,  /* `width` doubles a row */
  BBSIM_HDF5_AXIS     /* `width` doubles in all, which go along the series of each row */
} bbsim_hdf5_kind;

typedef struct bbsim_hdf5_column {
  const char *name, *unit, *description; /* UTF-8; the unit is one of UDUNITS, or empty */
  bbsim_hdf5_kind kind;
  size_t width; /* of a text, the bytes of each string, or 1 for any number of them; otherwise 1 if
                   the kind does not say otherwise */
  int is_scale; /* of the rows of all other columns; at most one column is */
  int is_packed; /* compressed, if the library can */
} bbsim_hdf5_column;

typedef enum bbsim_hdf5_value {
  BBSIM_HDF5_TEXT_VALUE,
  BBSIM_HDF5_REAL_VALUE,
  BBSIM_HDF5_INTEGER_VALUE
} bbsim_hdf5_value;

typedef struct bbsim_hdf5_attribute {
  const char* name; /* UTF-8, as the text */
  bbsim_hdf5_value kind;
  const char* text; /* of these three, what the kind says */
  double real;
  int64_t integer;
} bbsim_hdf5_attribute;

/* Some rows of a column: strings of a text, otherwise numbers, `width` a row, row after row. */
typedef struct bbsim_hdf5_values {
  const double* numbers;
  const char* const* texts;
} bbsim_hdf5_values;

/* A column of a table that a scenario read, as it was called there and, as HDF5 can call it, here. */
typedef struct bbsim_hdf5_input_column {
  const char *title, *name; /* UTF-8 */
  const double* numbers;
} bbsim_hdf5_input_column;

typedef struct bbsim_hdf5_writer bbsim_hdf5_writer;

/* Functions that return int: 0 if all is well, otherwise *error says why. */
typedef struct bbsim_hdf5_module {
  int interface_version;

  /* Starts a file through `descriptor` (empty, open for reading and writing, stays the caller's):
     one extendible dataset a column; none is an axis. NULL if it fails. */
  bbsim_hdf5_writer* (*create)(int descriptor, const bbsim_hdf5_column* columns, size_t count,
                               bbsim_hdf5_error* error);
  /* Adds an axis, with its values, as a scale of every series of its width. */
  int (*write_axis)(bbsim_hdf5_writer* writer, const bbsim_hdf5_column* axis, const double* values,
                    bbsim_hdf5_error* error);
  /* Appends rows: columns[c], c < count as given to create(). */
  int (*append)(bbsim_hdf5_writer* writer, const bbsim_hdf5_values* columns, size_t rows,
                bbsim_hdf5_error* error);
  /* Adds a column of numbers that is known only once all rows are there: a number a row. */
  int (*write_column)(bbsim_hdf5_writer* writer, const bbsim_hdf5_column* column,
                      const double* values, bbsim_hdf5_error* error);
  /* Adds inputs/`name`, a table that `file` held: `count` columns of `rows` numbers. */
  int (*write_input)(bbsim_hdf5_writer* writer, const char* name, const char* file,
                     const bbsim_hdf5_input_column* columns, size_t count, size_t rows,
                     bbsim_hdf5_error* error);
  /* Sets the root's attributes and closes the file; only destroy() may follow. */
  int (*finish)(bbsim_hdf5_writer* writer, const bbsim_hdf5_attribute* attributes, size_t count,
                bbsim_hdf5_error* error);
  /* Frees the writer, finished or not; NULL is allowed. */
  void (*destroy)(bbsim_hdf5_writer* writer);
} bbsim_hdf5_module;

/* The module's only symbol, and its type. */
#define BBSIM_HDF5_ENTRY "bbsim_hdf5_entry"
typedef const bbsim_hdf5_module* (*bbsim_hdf5_entry_function)(void);

#ifdef __cplusplus
}
#endif
#endif
