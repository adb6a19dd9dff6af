// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// SUNDIALS 6 or 7 with owned handles and checked return codes.
#pragma once

#include <cvodes/cvodes.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_context.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include <cstddef>
#include <memory>
#include <new>
#include <stdexcept>
#include <string>
#include <type_traits>

namespace bbsim::solve::sundials {

// Throws std::runtime_error. For calls that fail only through a mistake in bbsim or lack of memory.
inline void check(int flag, const char* call) {
  if (flag < 0) {
    throw std::runtime_error(std::string(call) + " failed with SUNDIALS code " +
                             std::to_string(flag));
  }
}

template <class Pointer, void (*destroy)(Pointer)>
struct Destroy {
  void operator()(Pointer handle) const { destroy(handle); }
};

template <class Handle, void (*destroy)(Handle)>
using Owner = std::unique_ptr<std::remove_pointer_t<Handle>, Destroy<Handle, destroy>>;

inline void free_context(SUNContext context) {
  SUNContext_Free(&context);
}
inline void free_vector(N_Vector vector) {
  N_VDestroy(vector);
}
inline void free_matrix(SUNMatrix matrix) {
  SUNMatDestroy(matrix);
}
inline void free_linear_solver(SUNLinearSolver solver) {
  SUNLinSolFree(solver);
}
inline void free_nonlinear_solver(SUNNonlinearSolver solver) {
  SUNNonlinSolFree(solver);
}
inline void free_cvode(void* memory) {
  CVodeFree(&memory);
}

using Context = Owner<SUNContext, free_context>;
using Vector = Owner<N_Vector, free_vector>;
using DenseMatrix = Owner<SUNMatrix, free_matrix>;
using LinearSolver = Owner<SUNLinearSolver, free_linear_solver>;
using NonlinearSolver = Owner<SUNNonlinearSolver, free_nonlinear_solver>;
struct Cvode {
  void operator()(void* memory) const { free_cvode(memory); }
};
using CvodeMemory = std::unique_ptr<void, Cvode>;

template <class Pointer>
Pointer created(Pointer handle) {
  if (handle == nullptr) throw std::bad_alloc();
  return handle;
}

inline Context make_context() {
  SUNContext context = nullptr;
#if SUNDIALS_VERSION_MAJOR >= 7
  check(SUNContext_Create(SUN_COMM_NULL, &context), "SUNContext_Create");
  // Return codes say everything that the default handler would print.
  SUNContext_ClearErrHandlers(context);
#else
  check(SUNContext_Create(nullptr, &context), "SUNContext_Create");
#endif
  return Context(context);
}

// Keeps SUNDIALS' messages off the terminal. The return codes are enough.
inline void silence([[maybe_unused]] void* cvode) {
#if SUNDIALS_VERSION_MAJOR < 7
  check(CVodeSetErrFile(cvode, nullptr), "CVodeSetErrFile");
#endif
}

inline Vector make_vector(std::size_t size, SUNContext context) {
  return Vector(created(N_VNew_Serial(static_cast<sunindextype>(size), context)));
}

inline double* data(const Vector& vector) {
  return N_VGetArrayPointer(vector.get());
}

}  // namespace bbsim::solve::sundials
