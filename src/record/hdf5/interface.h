/* The C interface between the program and its HDF5 module, which is opened at run time. No C++
   type and no exception crosses it; each side frees what it allocated. */
#ifndef BBSIM_RECORD_HDF5_INTERFACE_H
#define BBSIM_RECORD_HDF5_INTERFACE_H

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Grows with every change below; program and module refuse each other if theirs differ. */
enum { BBSIM_HDF5_INTERFACE = 2 };

/* Why a call failed: `system_error` is the errno of a failed write, or 0 if `text` tells. */
typedef struct bbsim_hdf5_error {
  int system_error;
  char text[500];
} bbsim_hdf5_error;

/* What a dataset of the root group holds. */
typedef enum bbsim_hdf5_kind {
  BBSIM_HDF5_NUMBER, /* a double a row */
  BBSIM_HDF5_SCALE,  /* the same, as the dimension scale of all others; reads back as a number */
  BBSIM_HDF5_TEXT,   /* a string a row */
  BBSIM_HDF5_SERIES, /* `width` doubles a row */
  BBSIM_HDF5_AXIS    /* `width` doubles in all, apart from the rows */
} bbsim_hdf5_kind;

typedef struct bbsim_hdf5_column {
  const char *name, *unit, *description; /* UTF-8 */
  bbsim_hdf5_kind kind;
  size_t width; /* 1 if the kind does not say otherwise */
} bbsim_hdf5_column;

typedef struct bbsim_hdf5_attribute {
  const char *name, *value; /* UTF-8 */
} bbsim_hdf5_attribute;

/* Some rows of a column: strings of a text, otherwise numbers, `width` a row, row after row. */
typedef struct bbsim_hdf5_values {
  const double* numbers;
  const char* const* texts;
} bbsim_hdf5_values;

/* Where open() tells what a file holds, in the file's order. What it passes lives as long as the
   call. Each returns 0 to go on, must not throw. */
typedef struct bbsim_hdf5_contents {
  void* context;
  int (*dataset)(void* context, const bbsim_hdf5_column* column, size_t rows);
  int (*attribute)(void* context, const bbsim_hdf5_attribute* attribute);
} bbsim_hdf5_contents;

/* Where read_texts() delivers, a call a row. Returns 0 to go on, must not throw. */
typedef struct bbsim_hdf5_texts {
  void* context;
  int (*text)(void* context, const char* text);
} bbsim_hdf5_texts;

typedef struct bbsim_hdf5_writer bbsim_hdf5_writer;
typedef struct bbsim_hdf5_reader bbsim_hdf5_reader;

/* Functions that return int: 0 if all is well, otherwise *error says why. */
typedef struct bbsim_hdf5_module {
  int interface_version;

  /* Starts a file through `descriptor` (empty, open for reading and writing, stays the caller's):
     one extendible dataset a column; none is an axis. NULL if it fails. */
  bbsim_hdf5_writer* (*create)(int descriptor, const bbsim_hdf5_column* columns, size_t count,
                               bbsim_hdf5_error* error);
  /* Adds an axis, with its values. */
  int (*write_axis)(bbsim_hdf5_writer* writer, const bbsim_hdf5_column* axis, const double* values,
                    bbsim_hdf5_error* error);
  /* Appends rows: columns[c], c < count as given to create(). */
  int (*append)(bbsim_hdf5_writer* writer, const bbsim_hdf5_values* columns, size_t rows,
                bbsim_hdf5_error* error);
  /* Sets the root's attributes and closes the file; only destroy() may follow. */
  int (*finish)(bbsim_hdf5_writer* writer, const bbsim_hdf5_attribute* attributes, size_t count,
                bbsim_hdf5_error* error);
  /* Frees the writer, finished or not; NULL is allowed. */
  void (*destroy)(bbsim_hdf5_writer* writer);

  /* Opens a file and tells its root's datasets, each of which must be of one of the kinds, and
     the string attributes. NULL if it fails. */
  bbsim_hdf5_reader* (*open)(const char* path, const bbsim_hdf5_contents* contents,
                             bbsim_hdf5_error* error);
  /* Rows [first, first + rows) of a dataset, counted in the order told, that is no text; an axis
     has `width` rows of one double. Within what there is. */
  int (*read_numbers)(bbsim_hdf5_reader* reader, size_t dataset, size_t first, size_t rows,
                      double* to, bbsim_hdf5_error* error);
  /* The same of a text. */
  int (*read_texts)(bbsim_hdf5_reader* reader, size_t dataset, size_t first, size_t rows,
                    const bbsim_hdf5_texts* to, bbsim_hdf5_error* error);
  /* Frees the reader; NULL is allowed. */
  void (*close)(bbsim_hdf5_reader* reader);
} bbsim_hdf5_module;

/* The module's only symbol, and its type. */
#define BBSIM_HDF5_ENTRY "bbsim_hdf5_entry"
typedef const bbsim_hdf5_module* (*bbsim_hdf5_entry_function)(void);

#ifdef __cplusplus
}
#endif
#endif
