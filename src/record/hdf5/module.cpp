// The module's functions for the program: the C++ inside, with every exception turned into a
// bbsim_hdf5_error at the border.
#include <exception>
#include <memory>

#include "record/hdf5/interface.h"
#include "record/hdf5/reader.hpp"
#include "record/hdf5/writer.hpp"

struct bbsim_hdf5_writer {
  bbsim::hdf5::Writer writer;
};

namespace bbsim::hdf5 {

void fail(const char* doing) {
  std::string reason;
  // Upward begins with the most specific entry.
  H5Ewalk2(
      H5E_DEFAULT, H5E_WALK_UPWARD,
      [](unsigned, const H5E_error2_t* entry, void* text) -> herr_t {
        *static_cast<std::string*>(text) = entry->desc != nullptr ? entry->desc : "";
        return 1;  // enough
      },
      &reason);
  throw Failure(std::string(doing) + " failed" + (reason.empty() ? "" : ": " + reason));
}

namespace {

// Copies what fits; error.text is always terminated.
void set_error(bbsim_hdf5_error& error, int system_error, std::string_view text) {
  error.system_error = system_error;
  error.text[text.copy(error.text, sizeof error.text - 1)] = '\0';
}

// Runs `action`; returns 0, or 1 with *error filled in.
template <class Action>
int guarded(bbsim_hdf5_error* error, Action action) noexcept {
  try {
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // nothing on standard error: we report
    action();
    return 0;
  } catch (const std::exception& exception) {
    set_error(*error, 0, exception.what());
  } catch (...) {
    set_error(*error, 0, "an unknown error of the HDF5 module");
  }
  return 1;
}

// The system's error, if there is one, is the cause of whatever HDF5 says.
int with_system_error(int result, const Writer& writer, bbsim_hdf5_error* error) {
  if (writer.system_error() == 0) return result;
  set_error(*error, writer.system_error(), "");
  return 1;
}

bbsim_hdf5_writer* create(int descriptor, const bbsim_hdf5_column* columns, std::size_t count,
                          bbsim_hdf5_error* error) {
  bbsim_hdf5_writer* writer = nullptr;
  guarded(error,
          [&] { writer = new bbsim_hdf5_writer{Writer(descriptor, std::span(columns, count))}; });
  return writer;
}

int append(bbsim_hdf5_writer* writer, const double* const* columns, std::size_t rows,
           bbsim_hdf5_error* error) {
  const int result = guarded(error, [&] { writer->writer.append(columns, rows); });
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

int read_file(const char* path, const bbsim_hdf5_sink* sink, bbsim_hdf5_error* error) {
  return guarded(error, [&] { read(path, *sink); });
}

}  // namespace
}  // namespace bbsim::hdf5

extern "C" __attribute__((visibility("default"))) const bbsim_hdf5_module* bbsim_hdf5_entry() {
  using namespace bbsim::hdf5;
  static const bbsim_hdf5_module module{
      BBSIM_HDF5_INTERFACE, create, append, finish, destroy, read_file};
  return &module;
}
