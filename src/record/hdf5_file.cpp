#include "record/hdf5_file.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <vector>

#include "base/error.hpp"
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

}  // namespace

Hdf5Output::Hdf5Output(const std::string& target, std::span<const bbsim_hdf5_column> columns,
                       Durable durable)
    : target_(target),
      module_(module_to_write(target)),
      file_(target, durable),
      writer_(nullptr, module_.destroy) {
  bbsim_hdf5_error error{};
  writer_.reset(module_.create(file_.descriptor(), columns.data(), columns.size(), &error));
  if (writer_ == nullptr) fail(error);
}

void Hdf5Output::write_axis(const bbsim_hdf5_column& axis, const double* values) {
  check_open();
  bbsim_hdf5_error error{};
  if (module_.write_axis(writer_.get(), &axis, values, &error) != 0) fail(error);
}

void Hdf5Output::append(const bbsim_hdf5_values* columns, std::size_t rows) {
  check_open();
  bbsim_hdf5_error error{};
  if (module_.append(writer_.get(), columns, rows, &error) != 0) fail(error);
}

void Hdf5Output::finish(const Attributes& attributes) {
  check_open();
  std::vector<bbsim_hdf5_attribute> pairs;
  pairs.reserve(attributes.size());
  for (const auto& [name, value] : attributes) pairs.push_back({name.c_str(), value.c_str()});
  bbsim_hdf5_error error{};
  if (module_.finish(writer_.get(), pairs.data(), pairs.size(), &error) != 0) fail(error);
  writer_.reset();
  file_.commit();
}

void require_hdf5(const std::string& target) {
  static_cast<void>(module_to_write(target));
}

void Hdf5Output::check_open() const {
  if (writer_ != nullptr) return;
  throw OutputError("cannot write " + target_ + ": it is complete, or a part of it has failed");
}

void Hdf5Output::fail(const bbsim_hdf5_error& error) {
  writer_.reset();  // with rows missing, the file must not get its name
  if (error.system_error != 0) file_.fail(error.system_error);
  throw OutputError("cannot write " + target_ + ": " + error.text);
}

Hdf5Input::Hdf5Input(const std::string& file, const bbsim_hdf5_contents& contents)
    : file_(file), reader_(nullptr, nullptr) {
  struct stat status {};
  if (stat(file.c_str(), &status) != 0 || access(file.c_str(), R_OK) != 0) fail(error_text(errno));
  if (!S_ISREG(status.st_mode)) fail("it is no regular file");
  const Hdf5Module& module = hdf5_module();
  if (module.functions == nullptr) fail(module.trouble);
  module_ = module.functions;
  bbsim_hdf5_error error{};
  reader_ = {module_->open(file.c_str(), &contents, &error), module_->close};
  if (reader_ == nullptr) fail(error.text);
}

void Hdf5Input::read_numbers(std::size_t dataset, std::size_t first, std::size_t rows,
                             double* to) const {
  bbsim_hdf5_error error{};
  if (module_->read_numbers(reader_.get(), dataset, first, rows, to, &error) != 0) fail(error.text);
}

void Hdf5Input::read_texts(std::size_t dataset, std::size_t first, std::size_t rows,
                           const bbsim_hdf5_texts& to) const {
  bbsim_hdf5_error error{};
  if (module_->read_texts(reader_.get(), dataset, first, rows, &to, &error) != 0) fail(error.text);
}

void Hdf5Input::fail(std::string_view reason) const {
  throw InputError("cannot read " + file_ + ": " + std::string(reason));
}

}  // namespace bbsim::record
