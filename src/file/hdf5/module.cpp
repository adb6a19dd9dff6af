// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The module's functions: one at a time, with every exception as a Trouble.
#include <hdf5.h>

#include <exception>
#include <memory>
#include <mutex>
#include <utility>

#include "file/hdf5/interface.hpp"
#include "file/hdf5/reader.hpp"
#include "file/hdf5/writer.hpp"

extern "C" {
extern __attribute__((visibility("default"))) bbsim::file::hdf5::Module bbsim_hdf5_module;
}

namespace bbsim::file::hdf5 {
namespace {

template <class Action>
Trouble guarded(Action action) noexcept {
  const std::lock_guard lock(*bbsim_hdf5_module.turns);
  Trouble trouble;
  try {
    // HDF5's cleanup at exit may crash if memory ran out earlier, and all files are closed by then.
    // This call has no effect if other code already uses HDF5.
    [[maybe_unused]] static const herr_t ignored = H5dont_atexit();
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // keeps HDF5 from writing to standard error
    try {
      action();
    } catch (const Failure& failure) {
      trouble.system_error = failure.system_error();
      trouble.text = failure.what();
    }
  } catch (const std::exception&) {
    trouble.no_memory = true;  // std::bad_alloc or std::length_error, also in the handler above
  }
  return trouble;
}

class GuardedWriter final : public Writer {
 public:
  explicit GuardedWriter(std::unique_ptr<FileWriter> file) : file_(std::move(file)) {}
  ~GuardedWriter() override {
    static_cast<void>(guarded([this] { file_.reset(); }));
  }
  Trouble append(const Hdf5Block& block) override {
    return guarded([&] { file_->append(block); });
  }
  Trouble add_column(const Hdf5Column& column, const std::vector<double>& values) override {
    return guarded([&] { file_->add_column(column, values); });
  }
  Trouble keep(const std::vector<InputTable>& inputs) override {
    return guarded([&] { file_->keep(inputs); });
  }
  Trouble finish(const Attributes& attributes) override {
    return guarded([&] { file_->finish(attributes); });
  }

 private:
  std::unique_ptr<FileWriter> file_;
};

class GuardedReader final : public Reader {
 public:
  explicit GuardedReader(std::unique_ptr<FileReader> file) : file_(std::move(file)) {}
  ~GuardedReader() override {
    static_cast<void>(guarded([this] { file_.reset(); }));
  }
  Trouble read(std::size_t first, std::size_t rows, Hdf5Block& into) override {
    return guarded([&] { file_->read(first, rows, into); });
  }
  Trouble read_inputs(std::vector<InputTable>& into) override {
    return guarded([&] { into = file_->read_inputs(); });
  }

 private:
  std::unique_ptr<FileReader> file_;
};

Trouble create(const std::string& file, const std::vector<Hdf5Column>& columns,
               const std::vector<Hdf5Axis>& axes, std::unique_ptr<Writer>& into) {
  return guarded([&] {
    into = std::make_unique<GuardedWriter>(std::make_unique<FileWriter>(file, columns, axes));
  });
}

Trouble open(const std::string& file, Hdf5Head& head, std::unique_ptr<Reader>& into) {
  return guarded(
      [&] { into = std::make_unique<GuardedReader>(std::make_unique<FileReader>(file, head)); });
}

}  // namespace
}  // namespace bbsim::file::hdf5

bbsim::file::hdf5::Module bbsim_hdf5_module{bbsim::file::hdf5::this_build,
                                            bbsim::file::hdf5::create, bbsim::file::hdf5::open};
