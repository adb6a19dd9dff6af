/* The C interface between the program and its HDF5 module, which is opened at run time. No C++
   type and no exception crosses it; each side frees what it allocated. */
#ifndef BBSIM_RECORD_HDF5_INTERFACE_H
#define BBSIM_RECORD_HDF5_INTERFACE_H

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Grows with every change below; program and module refuse each other if theirs differ. */
enum { BBSIM_HDF5_INTERFACE = 1 };

/* Why a call failed: `system_error` is the errno of a failed write, or 0 if `text` tells. */
typedef struct bbsim_hdf5_error {
  int system_error;
  char text[500];
} bbsim_hdf5_error;

typedef struct bbsim_hdf5_column {
  const char *name, *unit, *description; /* UTF-8 */
} bbsim_hdf5_column;

typedef struct bbsim_hdf5_attribute {
  const char *name, *value; /* UTF-8 */
} bbsim_hdf5_attribute;

/* Where read() delivers: for each column, in the file's order, returns room for `rows` doubles,
   or NULL to give up. Must not throw. */
typedef struct bbsim_hdf5_sink {
  void* context;
  double* (*column)(void* context, const char* name, size_t rows);
} bbsim_hdf5_sink;

typedef struct bbsim_hdf5_writer bbsim_hdf5_writer;

/* Functions that return int: 0 if all is well, otherwise *error says why. */
typedef struct bbsim_hdf5_module {
  int interface_version;

  /* Starts a file through `descriptor` (empty, open for reading and writing, stays the caller's):
     one extendible dataset a column. NULL if it fails. */
  bbsim_hdf5_writer* (*create)(int descriptor, const bbsim_hdf5_column* columns, size_t count,
                               bbsim_hdf5_error* error);
  /* Appends columns[c][row], c < count as given to create(). */
  int (*append)(bbsim_hdf5_writer* writer, const double* const* columns, size_t rows,
                bbsim_hdf5_error* error);
  /* Sets the root's attributes and closes the file; only destroy() may follow. */
  int (*finish)(bbsim_hdf5_writer* writer, const bbsim_hdf5_attribute* attributes, size_t count,
                bbsim_hdf5_error* error);
  /* Frees the writer, finished or not; NULL is allowed. */
  void (*destroy)(bbsim_hdf5_writer* writer);

  /* Reads every dataset of the root group; each must be one-dimensional and hold numbers. */
  int (*read)(const char* path, const bbsim_hdf5_sink* sink, bbsim_hdf5_error* error);
} bbsim_hdf5_module;

/* The module's only symbol, and its type. */
#define BBSIM_HDF5_ENTRY "bbsim_hdf5_entry"
typedef const bbsim_hdf5_module* (*bbsim_hdf5_entry_function)(void);

#ifdef __cplusplus
}
#endif
#endif
