// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Symbols of Open MPI that Debian's static SUNDIALS 7 library needs to link. Without a
// communicator, none of them is called; see mpi.h.
#include "mpi.h"

#include <stdio.h>
#include <stdlib.h>

char ompi_mpi_comm_null[1];
char ompi_mpi_double[1];
char ompi_mpi_long[1];

#define NEVER_CALLED(name)                                                        \
  int name(void) {                                                                \
    fputs("SUNDIALS called " #name ", but bbsim is built without MPI\n", stderr); \
    abort();                                                                      \
  }

NEVER_CALLED(MPI_Abort)
NEVER_CALLED(MPI_Comm_dup)
NEVER_CALLED(MPI_Comm_free)
NEVER_CALLED(MPI_Comm_rank)
NEVER_CALLED(MPI_Comm_size)
NEVER_CALLED(MPI_Op_create)
NEVER_CALLED(MPI_Op_free)
NEVER_CALLED(MPI_Reduce)
NEVER_CALLED(MPI_Type_commit)
NEVER_CALLED(MPI_Type_create_resized)
NEVER_CALLED(MPI_Type_create_struct)
NEVER_CALLED(MPI_Type_free)
NEVER_CALLED(MPI_Type_get_extent)
