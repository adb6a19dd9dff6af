// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Opens the HDF5 module, and writes and reads tables through it, with its troubles as exceptions.
#include "file/hdf5_table.hpp"

#include <dlfcn.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <iterator>
#include <mutex>

#include "base/error.hpp"
#include "base/text.hpp"
#include "file/descriptor.hpp"
#include "file/hdf5/interface.hpp"
#include "file/share_folders.hpp"

namespace bbsim::file {
namespace {

constexpr const char* module_name = "libbbsim_hdf5.so";
constexpr const char* way_out = "; write or read .csv instead, ";

ForkMutex opening, turns;  // a forked process must not wait for a thread that it does not have
const Hdf5Module* the_module = nullptr;

// The module, which is opened at the first call.
const Hdf5Module& hdf5_module() {
  const std::lock_guard lock(opening);
  // Never destroyed, because a thread may write until the process ends.
  if (the_module == nullptr) the_module = new Hdf5Module(open_hdf5_module(hdf5_module_folders()));
  return *the_module;
}

// Rows per call of HDF5: fewer if rows are wide, and always a power of two. This makes the file's
// bytes independent of the caller's blocks.
constexpr std::size_t most_rows_at_once = 1024;
constexpr std::size_t most_bytes_at_once = std::size_t{8} * 1024 * 1024;

// Numbers per row.
std::size_t width_of(const Hdf5Column& column) {
  return column.kind == Hdf5Kind::series ? column.width : column.kind == Hdf5Kind::text ? 0 : 1;
}

std::size_t rows_at_once(const std::vector<Hdf5Column>& columns) {
  std::size_t bytes = 0;  // of a row, without the text of strings
  for (const Hdf5Column& column : columns) {
    bytes += column.kind == Hdf5Kind::text
                 ? sizeof(std::string)
                 : std::min(width_of(column), most_bytes_at_once) * sizeof(double);
  }
  std::size_t rows = most_rows_at_once;
  while (rows > 1 && rows * bytes > most_bytes_at_once) rows /= 2;
  return rows;
}

constexpr const char* no_memory = "there is not enough memory for its content";

[[noreturn]] void refuse_output(const std::string& target, const std::string& reason) {
  throw OutputError("cannot write " + target + ": " + reason);
}

const hdf5::Module& module_to_write(const std::string& target) {
  const Hdf5Module& module = hdf5_module();
  if (module.functions == nullptr) refuse_output(target, module.trouble);
  return *module.functions;
}

// Checks everything before it touches a file.
const std::string& checked(const std::string& target) {
  if (is_written_directly(target)) {
    refuse_output(
        target,
        "it is a device, a pipe or standard output, and HDF5 needs a regular file; name one");
  }
  require_hdf5(target);
  return target;
}

Hdf5Column column_of(const ColumnHeader& header) {
  return {std::string(header.name), std::string(header.unit), std::string(header.meaning)};
}

}  // namespace

Hdf5Module open_hdf5_module(const std::vector<std::string>& folders) {
  std::string file, looked_in;
  for (const std::string& folder : folders) {
    file = folder + "/" + module_name;
    if (access(file.c_str(), F_OK) == 0) break;
    file.clear();
    looked_in.append(looked_in.empty() ? "" : " and ").append(folder);
  }
  if (file.empty()) {
    return {nullptr,
            std::string("the HDF5 module ") + module_name + " is not in " + looked_in + way_out +
                "or install all of bbsim, or set BBSIM_MODULE_PATH to the module's folder"};
  }
  // Never closed, because the open files of any thread may need it.
  void* library = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) {
    return {nullptr, std::string("the HDF5 module cannot be loaded: ") + dlerror() + way_out +
                         "or install the HDF5 library that it was built with"};
  }
  auto* functions = static_cast<hdf5::Module*>(dlsym(library, hdf5::module_symbol));
  if (functions == nullptr || std::string_view(functions->build) != hdf5::this_build) {
    return {nullptr, "the HDF5 module " + file + " belongs to another version of bbsim" + way_out +
                         "or install the two together"};
  }
  functions->turns = &turns;
  return {functions, ""};
}

std::vector<std::string> hdf5_module_folders() {
  if (const char* folder = std::getenv("BBSIM_MODULE_PATH"); folder != nullptr && *folder != '\0') {
    return {folder};
  }
  // Covers a library in PREFIX/lib and a Python module in PREFIX/lib/python3/dist-packages/bbsim.
  const std::filesystem::path library = own_library();
  return library.empty() ? folders_of_prefix("lib", BBSIM_INSTALL_LIBDIR)
                         : folders_above(library, 4, "bbsim");
}

void require_hdf5(const std::string& target) {
  static_cast<void>(module_to_write(target));
}

Hdf5TableWriter::Hdf5TableWriter(const std::string& target, const std::vector<Hdf5Column>& columns,
                                 const std::vector<Hdf5Axis>& axes, Durable durable)
    : target_(target),
      columns_(columns),
      rows_at_once_(rows_at_once(columns)),
      waiting_{0, std::vector<std::vector<double>>(columns.size()),
               std::vector<std::vector<std::string>>(columns.size())},
      file_(checked(target), durable) {
  // Takes the numbers of closed standard streams: HDF5's file would have one, and messages would go
  // into it.
  std::array<Descriptor, 3> taken;
  for (Descriptor& descriptor : taken)
    descriptor = Descriptor(::open("/dev/null", O_RDONLY | O_CLOEXEC));
  check(module_to_write(target).create(file_.temporary(), columns, axes, writer_));
}

Hdf5TableWriter::~Hdf5TableWriter() = default;

void Hdf5TableWriter::append(const Hdf5Block& block) {
  bool fits = block.values.size() == columns_.size() && block.texts.size() == columns_.size();
  for (std::size_t c = 0; fits && c < columns_.size(); ++c) {
    fits = block.values[c].size() == block.rows * width_of(columns_[c]) &&
           block.texts[c].size() == (columns_[c].kind == Hdf5Kind::text ? block.rows : 0);
  }
  if (!fits) refuse_output(target_, "a block of rows does not have the shape of the columns");
  for (std::size_t first = 0; first < block.rows;) {
    const std::size_t last = first + std::min(block.rows - first, rows_at_once_ - waiting_.rows);
    const auto add = [&](auto& to, const auto& from, std::size_t width) {
      to.insert(to.end(), from.begin() + static_cast<std::ptrdiff_t>(first * width),
                from.begin() + static_cast<std::ptrdiff_t>(last * width));
    };
    for (std::size_t c = 0; c < columns_.size(); ++c) {
      add(waiting_.values[c], block.values[c], width_of(columns_[c]));
      add(waiting_.texts[c], block.texts[c], columns_[c].kind == Hdf5Kind::text ? 1 : 0);
    }
    waiting_.rows += last - first;
    first = last;
    if (waiting_.rows == rows_at_once_) flush();
  }
  rows_ += block.rows;
}

void Hdf5TableWriter::append(std::span<const double* const> columns, std::size_t rows) {
  Hdf5Block block{rows, {}, std::vector<std::vector<std::string>>(columns.size())};
  for (const double* column : columns) block.values.emplace_back(column, column + rows);
  append(block);
}

void Hdf5TableWriter::flush() {
  check(open_writer().append(waiting_));
  for (auto& column : waiting_.values) column.clear();
  for (auto& column : waiting_.texts) column.clear();
  waiting_.rows = 0;
}

void Hdf5TableWriter::add_column(const ColumnHeader& header, const std::vector<double>& values) {
  if (values.size() != rows_) {
    refuse_output(target_, "a column does not have as many rows as the others");
  }
  flush();
  check(open_writer().add_column(column_of(header), values));
}

void Hdf5TableWriter::keep(const std::vector<InputTable>& inputs) {
  check(open_writer().keep(inputs));
}

void Hdf5TableWriter::finish(const Attributes& attributes) {
  flush();
  check(open_writer().finish(attributes));
  writer_.reset();
  file_.commit();
}

hdf5::Writer& Hdf5TableWriter::open_writer() {
  if (writer_ == nullptr) refuse_output(target_, "it is complete, or one of its parts failed");
  return *writer_;
}

void Hdf5TableWriter::check(const hdf5::Trouble& trouble) {
  if (trouble.text.empty() && !trouble.no_memory) return;
  writer_.reset();  // an incomplete file must not get its final name
  if (trouble.no_memory) refuse_output(target_, no_memory);
  if (trouble.system_error != 0) file_.fail(trouble.system_error);
  refuse_output(target_, shown(trouble.text, uncut));
}

Hdf5TableReader::Hdf5TableReader(const std::string& file, std::size_t rows_a_block)
    : file_(file), rows_a_block_(rows_a_block) {
  struct stat status {};
  if (stat(file.c_str(), &status) != 0 || access(file.c_str(), R_OK) != 0) {
    fail(error_text(errno));
  }
  if (!S_ISREG(status.st_mode)) fail("it is not a regular file");
  const Hdf5Module& module = hdf5_module();
  if (module.functions == nullptr) fail(module.trouble);
  check(module.functions->open(file, head_, reader_));
}

Hdf5TableReader::~Hdf5TableReader() = default;
Hdf5TableReader::Hdf5TableReader(Hdf5TableReader&&) noexcept = default;

bool Hdf5TableReader::read(Hdf5Block& into) {
  check(reader_->read(next_, std::min(rows_a_block_, rows() - next_), into));
  next_ += into.rows;
  return into.rows > 0;
}

std::vector<InputTable> Hdf5TableReader::read_inputs() {
  std::vector<InputTable> inputs;
  check(reader_->read_inputs(inputs));
  return inputs;
}

void Hdf5TableReader::fail(std::string_view reason) const {
  throw InputError("cannot read " + shown(file_, uncut) + ": " + std::string(reason));
}

void Hdf5TableReader::check(const hdf5::Trouble& trouble) const {
  if (trouble.no_memory) fail(no_memory);
  if (trouble.system_error != 0) fail(error_text(trouble.system_error));
  if (!trouble.text.empty()) fail(shown(trouble.text, uncut));
}

std::unique_ptr<TableWriter> open_hdf5(const std::string& target,
                                       const std::vector<ColumnHeader>& headers) {
  std::vector<Hdf5Column> columns;
  std::ranges::transform(headers, std::back_inserter(columns), column_of);
  return std::make_unique<Hdf5TableWriter>(target, columns, std::vector<Hdf5Axis>(), Durable::no);
}

Table read_hdf5(const std::string& file) {
  constexpr std::size_t rows_at_a_time = 65536;
  Hdf5TableReader reader(file, rows_at_a_time);
  Table table;
  for (const Hdf5Column& column : reader.columns()) {
    table.columns.push_back({column.name, {}, {}, column.unit});
    if (column.kind == Hdf5Kind::series) table.columns.back().width = column.width;
  }
  Hdf5Block block;
  while (reader.read(block)) {
    for (std::size_t c = 0; c < table.columns.size(); ++c) {
      Column& column = table.columns[c];
      for (std::string& text : block.texts[c]) column.add_text(std::move(text));
      column.numbers.insert(column.numbers.end(), block.values[c].begin(), block.values[c].end());
    }
  }
  for (const auto& [column, values] : reader.head().axes) {
    // One row with all values of the axis.
    table.columns.push_back({column.name, values, {}, column.unit, values.size()});
  }
  table.rows = reader.rows();
  table.attributes = reader.head().attributes;
  return table;
}

}  // namespace bbsim::file
