// HDF5 files as the program sees them: the module behind them, its errors as ours.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "record/atomic_file.hpp"
#include "record/hdf5/interface.h"
#include "record/table_writer.hpp"

namespace bbsim::record {

// A file on its way to its final name. What these take is as the module's interface says. Every
// function throws OutputError; after that, only destruction may follow.
class Hdf5Output {
 public:
  // Throws here, before any work is done, if the target cannot be written to.
  Hdf5Output(const std::string& target, std::span<const bbsim_hdf5_column> columns,
             Durable durable = Durable::no);

  void write_axis(const bbsim_hdf5_column& axis, const double* values);
  void append(const bbsim_hdf5_values* columns, std::size_t rows);
  // Completes the file and puts it under its final name. Without this call nothing stays.
  void finish(const Attributes& attributes);

 private:
  void check_open() const;
  [[noreturn]] void fail(const bbsim_hdf5_error& error);

  std::string target_;
  const bbsim_hdf5_module& module_;
  AtomicFile file_;  // outlives writer_, which writes to its descriptor
  std::unique_ptr<bbsim_hdf5_writer, void (*)(bbsim_hdf5_writer*)> writer_;
};

// Throws OutputError if this program cannot write HDF5.
void require_hdf5(const std::string& target);

// A file that is read. Every function throws InputError.
class Hdf5Input {
 public:
  Hdf5Input(const std::string& file, const bbsim_hdf5_contents& contents);

  void read_numbers(std::size_t dataset, std::size_t first, std::size_t rows, double* to) const;
  void read_texts(std::size_t dataset, std::size_t first, std::size_t rows,
                  const bbsim_hdf5_texts& to) const;

  [[noreturn]] void fail(std::string_view reason) const;

 private:
  std::string file_;
  std::unique_ptr<bbsim_hdf5_reader, void (*)(bbsim_hdf5_reader*)> reader_;
  const bbsim_hdf5_module* module_ = nullptr;
};

}  // namespace bbsim::record
