// HDF5 tables, through the module that knows HDF5.
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <new>
#include <stdexcept>

#include "base/error.hpp"
#include "record/atomic_file.hpp"
#include "record/formats.hpp"
#include "record/hdf5_module.hpp"

namespace bbsim::record {
namespace {

const bbsim_hdf5_module& module_to_write(const std::string& target) {
  const Hdf5Module& module = hdf5_module();
  if (module.functions == nullptr) {
    throw OutputError("cannot write " + target + ": " + module.trouble);
  }
  return *module.functions;
}

// The texts of a ColumnHeader as C strings, which string_views need not be.
struct Header {
  std::string name, unit, description;
};

class Hdf5Writer final : public TableWriter {
 public:
  Hdf5Writer(const std::string& target, const std::vector<ColumnHeader>& headers)
      : target_(target),
        module_(module_to_write(target)),
        file_(target),
        writer_(nullptr, module_.destroy) {
    std::vector<Header> texts;
    texts.reserve(headers.size());
    std::vector<bbsim_hdf5_column> columns;
    for (const ColumnHeader& header : headers) {
      const Header& text = texts.emplace_back(
          Header{std::string(header.name), std::string(header.unit), std::string(header.meaning)});
      columns.push_back({text.name.c_str(), text.unit.c_str(), text.description.c_str()});
    }
    bbsim_hdf5_error error{};
    writer_.reset(module_.create(file_.descriptor(), columns.data(), columns.size(), &error));
    if (writer_ == nullptr) fail(error);
  }

  void append(std::span<const double* const> columns, std::size_t rows) override {
    bbsim_hdf5_error error{};
    if (module_.append(writer_.get(), columns.data(), rows, &error) != 0) fail(error);
  }

  void finish(const Attributes& attributes) override {
    std::vector<bbsim_hdf5_attribute> pairs;
    pairs.reserve(attributes.size());
    for (const auto& [name, value] : attributes) pairs.push_back({name.c_str(), value.c_str()});
    bbsim_hdf5_error error{};
    if (module_.finish(writer_.get(), pairs.data(), pairs.size(), &error) != 0) fail(error);
    writer_.reset();
    file_.commit();
  }

 private:
  [[noreturn]] void fail(const bbsim_hdf5_error& error) const {
    if (error.system_error != 0) file_.fail(error.system_error);
    throw OutputError("cannot write " + target_ + ": " + error.text);
  }

  std::string target_;
  const bbsim_hdf5_module& module_;
  AtomicFile file_;  // outlives writer_, which writes to its descriptor
  std::unique_ptr<bbsim_hdf5_writer, void (*)(bbsim_hdf5_writer*)> writer_;
};

// The module's sink: no exception may go back through it.
double* add_column(void* context, const char* name, std::size_t rows) noexcept {
  auto& table = *static_cast<TableData*>(context);
  try {
    std::vector<double> column;
    column.reserve(rows + 1);  // data() of an empty vector may be null, which means to give up
    column.resize(rows);
    table.names.emplace_back(name);
    return table.columns.emplace_back(std::move(column)).data();
  } catch (const std::exception&) {
    return nullptr;
  }
}

}  // namespace

std::unique_ptr<TableWriter> open_hdf5(const std::string& target,
                                       const std::vector<ColumnHeader>& headers) {
  return std::make_unique<Hdf5Writer>(target, headers);
}

TableData read_hdf5(const std::string& file) {
  const std::string start = "cannot read " + file + ": ";
  struct stat status {};
  if (stat(file.c_str(), &status) != 0 || access(file.c_str(), R_OK) != 0) {
    throw InputError(start + error_text(errno));
  }
  if (!S_ISREG(status.st_mode)) throw InputError(start + "it is no regular file");

  const Hdf5Module& module = hdf5_module();
  if (module.functions == nullptr) throw InputError(start + module.trouble);
  TableData table;
  const bbsim_hdf5_sink sink{&table, add_column};
  bbsim_hdf5_error error{};
  if (module.functions->read(file.c_str(), &sink, &error) != 0) {
    throw InputError(start + error.text);
  }
  if (table.names.empty()) throw InputError(start + "it holds no datasets at its root");
  for (std::size_t c = 1; c < table.names.size(); ++c) {
    if (table.columns[c].size() != table.columns[0].size()) {
      throw InputError(start + "dataset " + table.names[c] + " has " +
                       std::to_string(table.columns[c].size()) + " rows, " + table.names[0] +
                       " has " + std::to_string(table.columns[0].size()) +
                       "; all must have the same number");
    }
  }
  return table;
}

}  // namespace bbsim::record
