/* SPDX-FileCopyrightText: 2026 the bbsim authors
 * SPDX-License-Identifier: BSD-3-Clause */

/* The C interface between the program and its HDF5 module, which writes files and is opened at run
   time. No C++ type and no exception crosses it. Each side frees what it allocated. (A separate
   process reads files: table_text.hpp.) */
#ifndef BBSIM_RECORD_HDF5_INTERFACE_H
#define BBSIM_RECORD_HDF5_INTERFACE_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Increases with every change below. The program refuses a module with another version. */
enum { BBSIM_HDF5_INTERFACE = 4 };

/* Why a call failed: the errno of a failed write, or `text` if system_error is 0. */
typedef struct bbsim_hdf5_error {
  int system_error;
  char text[500];
} bbsim_hdf5_error;

/* The content of a dataset. */
typedef enum bbsim_hdf5_kind {
  BBSIM_HDF5_NUMBER,  /* a double per row */
  BBSIM_HDF5_INTEGER, /* an integer per row: a double here, 64 bits in the file */
  BBSIM_HDF5_TEXT,    /* a string per row */
  BBSIM_HDF5_SERIES,  /* `width` doubles per row */
  BBSIM_HDF5_AXIS     /* `width` doubles in all, the axis of each row's series */
} bbsim_hdf5_kind;

typedef struct bbsim_hdf5_column {
  const char *name, *unit, *description; /* UTF-8; the unit is a UDUNITS unit or empty */
  bbsim_hdf5_kind kind;
  size_t width; /* text: bytes of each string, or 1 for any length; number and integer: 1 */
  int is_scale; /* whether it is the scale of the rows; at most one column is */
  int is_packed; /* whether to compress, if the library can */
} bbsim_hdf5_column;

typedef enum bbsim_hdf5_value {
  BBSIM_HDF5_TEXT_VALUE,
  BBSIM_HDF5_REAL_VALUE,
  BBSIM_HDF5_INTEGER_VALUE
} bbsim_hdf5_value;

typedef struct bbsim_hdf5_attribute {
  const char* name; /* UTF-8, like the text */
  bbsim_hdf5_value kind;
  const char* text; /* `kind` selects one of these three */
  double real;
  int64_t integer;
} bbsim_hdf5_attribute;

/* Some rows of a column: strings for text, otherwise `width` numbers per row, row after row. */
typedef struct bbsim_hdf5_values {
  const double* numbers;
  const char* const* texts;
} bbsim_hdf5_values;

/* A column of a table that a scenario read: its title there and its HDF5 name. */
typedef struct bbsim_hdf5_input_column {
  const char *title, *name; /* UTF-8 */
  const double* numbers;
} bbsim_hdf5_input_column;

typedef struct bbsim_hdf5_writer bbsim_hdf5_writer;

/* Functions that return int return 0 on success; otherwise they fill *error. */
typedef struct bbsim_hdf5_module {
  int interface_version;

  /* Starts a file with one extendible dataset per column; no column is an axis. `descriptor` is of
     an empty file, open for reading and writing; the caller keeps it. Returns NULL on failure. */
  bbsim_hdf5_writer* (*create)(int descriptor, const bbsim_hdf5_column* columns, size_t count,
                               bbsim_hdf5_error* error);
  /* Adds an axis as the scale of every series of its width. */
  int (*write_axis)(bbsim_hdf5_writer* writer, const bbsim_hdf5_column* axis, const double* values,
                    bbsim_hdf5_error* error);
  /* Appends rows: columns[c], c < count as given to create(). */
  int (*append)(bbsim_hdf5_writer* writer, const bbsim_hdf5_values* columns, size_t rows,
                bbsim_hdf5_error* error);
  /* Adds a column of numbers, one per row, after the last row. */
  int (*write_column)(bbsim_hdf5_writer* writer, const bbsim_hdf5_column* column,
                      const double* values, bbsim_hdf5_error* error);
  /* Adds the table from `file` as inputs/`name`: `count` columns of `rows` numbers. */
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
