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
struct bbsim_hdf5_reader {
  bbsim::hdf5::Reader reader;
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

int append(bbsim_hdf5_writer* writer, const bbsim_hdf5_values* columns, std::size_t rows,
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

bbsim_hdf5_reader* open(const char* path, const bbsim_hdf5_contents* contents,
                        bbsim_hdf5_error* error) {
  bbsim_hdf5_reader* reader = nullptr;
  guarded(error, [&] { reader = new bbsim_hdf5_reader{Reader(path, *contents)}; });
  return reader;
}

int read_numbers(bbsim_hdf5_reader* reader, std::size_t dataset, std::size_t first,
                 std::size_t rows, double* to, bbsim_hdf5_error* error) {
  return guarded(error, [&] { reader->reader.read_numbers(dataset, first, rows, to); });
}

int read_texts(bbsim_hdf5_reader* reader, std::size_t dataset, std::size_t first, std::size_t rows,
               const bbsim_hdf5_texts* to, bbsim_hdf5_error* error) {
  return guarded(error, [&] { reader->reader.read_texts(dataset, first, rows, *to); });
}

void close(bbsim_hdf5_reader* reader) {
  bbsim_hdf5_error ignored{};
  guarded(&ignored, [&] { delete reader; });
}

}  // namespace
}  // namespace bbsim::hdf5

extern "C" __attribute__((visibility("default"))) const bbsim_hdf5_module* bbsim_hdf5_entry() {
  using namespace bbsim::hdf5;
  static const bbsim_hdf5_module module{
      BBSIM_HDF5_INTERFACE, create,     write_axis, append, finish, destroy, open,
      read_numbers,         read_texts, close};
  return &module;
}
