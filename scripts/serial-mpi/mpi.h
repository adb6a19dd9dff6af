// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Replaces Open MPI's header for the SUNDIALS that scripts/setup unpacks: Debian builds SUNDIALS 7
// with MPI, so its headers use the type and the null communicator below. bbsim passes only the null
// communicator, with which SUNDIALS calls no MPI function.
#pragma once

#ifdef __cplusplus
extern "C" {
#endif

typedef struct ompi_communicator_t* MPI_Comm;
extern char ompi_mpi_comm_null[];  // SUNDIALS compares with its address
#define MPI_COMM_NULL ((MPI_Comm)(void*)ompi_mpi_comm_null)

#ifdef __cplusplus
}
#endif
