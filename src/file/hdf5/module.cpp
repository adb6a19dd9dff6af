// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The module's C functions. They call the C++ code and turn every exception into a
// bbsim_hdf5_error.
#include <hdf5.h>

#include <exception>
#include <memory>
#include <string_view>

#include "file/hdf5/interface.h"
#include "file/hdf5/writer.hpp"

struct bbsim_hdf5_writer {
  bbsim::hdf5::Writer writer;
};

namespace bbsim::hdf5 {

namespace {

// Cuts text that does not fit. error.text is always terminated.
void set_error(bbsim_hdf5_error& error, int system_error, std::string_view text) {
  error.system_error = system_error;
  error.text[text.copy(error.text, sizeof error.text - 1)] = '\0';
}

// Runs `action`. Returns 0, or 1 with *error filled in.
template <class Action>
int guarded(bbsim_hdf5_error* error, Action action) noexcept {
  try {
    // HDF5's cleanup at exit may crash if memory ran out earlier, and all files are closed by then.
    // This call has no effect if other code already uses HDF5.
    [[maybe_unused]] static const herr_t ignored = H5dont_atexit();
    keep_errors_to_ourselves();
    action();
    return 0;
  } catch (const std::exception& exception) {
    set_error(*error, 0, exception.what());
  } catch (...) {
    set_error(*error, 0, "an unknown error of the HDF5 module");
  }
  return 1;
}

// Reports the system's error, if any, because it is the cause of any error of HDF5.
int with_system_error(int result, const Writer& writer, bbsim_hdf5_error* error) {
  if (writer.system_error() == 0) return result;
  set_error(*error, writer.system_error(), "");
  return 1;
}

bbsim_hdf5_writer* create(int descriptor, const bbsim_hdf5_column* columns, std::size_t count,
                          bbsim_hdf5_error* error) {
  std::unique_ptr<bbsim_hdf5_writer> writer;
  int result = guarded(error, [&] {
    writer = std::make_unique<bbsim_hdf5_writer>();
    writer->writer.start(descriptor, std::span(columns, count));
  });
  if (writer != nullptr) result = with_system_error(result, writer->writer, error);
  return result == 0 ? writer.release() : nullptr;
}

int write_axis(bbsim_hdf5_writer* writer, const bbsim_hdf5_column* axis, const double* values,
               bbsim_hdf5_error* error) {
  const int result = guarded(error, [&] { writer->writer.write_axis(*axis, values); });
  return with_system_error(result, writer->writer, error);
}

int write_column(bbsim_hdf5_writer* writer, const bbsim_hdf5_column* column, const double* values,
                 bbsim_hdf5_error* error) {
  const int result = guarded(error, [&] { writer->writer.write_column(*column, values); });
  return with_system_error(result, writer->writer, error);
}

int append(bbsim_hdf5_writer* writer, const bbsim_hdf5_values* columns, std::size_t rows,
           bbsim_hdf5_error* error) {
  const int result = guarded(error, [&] { writer->writer.append(columns, rows); });
  return with_system_error(result, writer->writer, error);
}

int write_input(bbsim_hdf5_writer* writer, const char* name, const char* file,
                const bbsim_hdf5_input_column* columns, std::size_t count, std::size_t rows,
                bbsim_hdf5_error* error) {
  const int result = guarded(
      error, [&] { writer->writer.write_input(name, file, std::span(columns, count), rows); });
  return with_system_error(result, writer->writer, error);
}

int finish(bbsim_hdf5_writer* writer, const bbsim_hdf5_attribute* attributes, std::size_t count,
           bbsim_hdf5_error* error) {
  const int result = guarded(error, [&] { writer->writer.finish(std::span(attributes, count)); });
  return with_system_error(result, writer->writer, error);
}

void destroy(bbsim_hdf5_writer* writer) {
  bbsim_hdf5_error ignored{};
  guarded(&ignored, [&] { delete writer; });
}

}  // namespace
}  // namespace bbsim::hdf5

extern "C" __attribute__((visibility("default"))) const bbsim_hdf5_module* bbsim_hdf5_entry() {
  using namespace bbsim::hdf5;
  static const bbsim_hdf5_module module{BBSIM_HDF5_INTERFACE, create,      write_axis, append,
                                        write_column,         write_input, finish,     destroy};
  return &module;
}
