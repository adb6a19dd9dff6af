// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "file/hdf5_file.hpp"

#include <algorithm>
#include <set>
#include <string_view>

#include "base/error.hpp"
#include "base/printable.hpp"
#include "file/hdf5_guard.hpp"
#include "file/hdf5_module.hpp"

namespace bbsim::file {
namespace {

constexpr const char* crash =
    ": the HDF5 library crashed, as it may when memory runs out; end other programs, or write "
    ".csv\n";

std::string crash_message(const std::string& target) {
  return printable("cannot write " + target + crash);
}

const bbsim_hdf5_module& module_to_write(const std::string& target) {
  const std::string message = crash_message(target);
  const WithinHdf5 within(message.c_str());  // opens the library, perhaps
  const Hdf5Module& module = hdf5_module();
  if (module.functions == nullptr) {
    throw OutputError("cannot write " + target + ": " + module.trouble);
  }
  return *module.functions;
}

bbsim_hdf5_attribute described(const std::string& name, const AttributeValue& value) {
  bbsim_hdf5_attribute attribute{name.c_str(), BBSIM_HDF5_TEXT_VALUE, "", 0, 0};
  if (const auto* real = std::get_if<double>(&value.value())) {
    attribute.kind = BBSIM_HDF5_REAL_VALUE;
    attribute.real = *real;
  } else if (const auto* whole = std::get_if<std::int64_t>(&value.value())) {
    attribute.kind = BBSIM_HDF5_INTEGER_VALUE;
    attribute.integer = *whole;
  } else {
    attribute.text = std::get<std::string>(value.value()).c_str();
  }
  return attribute;
}

// A name like `wanted` that HDF5 accepts and that is not in `taken`. Adds it to `taken`.
std::string free_name(std::string wanted, std::set<std::string>& taken) {
  std::replace(wanted.begin(), wanted.end(), '/', '_');
  if (wanted.empty() || wanted == ".") wanted += '_';
  std::string name = wanted;
  for (int i = 2; !taken.insert(name).second; ++i) name = wanted + " (" + std::to_string(i) + ")";
  return name;
}

// "motion.csv" from "../tables/motion.csv".
std::string last_part(const std::string& file) {
  return file.substr(file.rfind('/') + 1);  // npos + 1 = 0: everything
}

}  // namespace

Hdf5Output::Hdf5Output(const std::string& target, std::span<const bbsim_hdf5_column> columns,
                       Durable durable)
    : target_(target),
      message_of_crash_(crash_message(target)),
      module_(module_to_write(target)),
      file_(target, durable),
      writer_(nullptr, Destroy{this}) {
  call([&](bbsim_hdf5_error* error) {
    writer_.reset(module_.create(file_.descriptor(), columns.data(), columns.size(), error));
    return writer_ == nullptr ? 1 : 0;
  });
}

void Hdf5Output::Destroy::operator()(bbsim_hdf5_writer* writer) const {
  const WithinHdf5 within(output->message_of_crash_.c_str());
  output->module_.destroy(writer);
}

template <class Function>
void Hdf5Output::call(const Function& function) {
  bbsim_hdf5_error error{};
  int result = 0;
  {
    const WithinHdf5 within(message_of_crash_.c_str());
    result = function(&error);
  }
  if (result != 0) fail(error);
}

void Hdf5Output::write_axis(const bbsim_hdf5_column& axis, const double* values) {
  check_open();
  call([&](auto* error) { return module_.write_axis(writer_.get(), &axis, values, error); });
}

void Hdf5Output::append(const bbsim_hdf5_values* columns, std::size_t rows) {
  check_open();
  call([&](auto* error) { return module_.append(writer_.get(), columns, rows, error); });
}

void Hdf5Output::write_column(const bbsim_hdf5_column& column, const double* values) {
  check_open();
  call([&](auto* error) { return module_.write_column(writer_.get(), &column, values, error); });
}

void Hdf5Output::write_inputs(const std::vector<InputTable>& inputs) {
  check_open();
  std::set<std::string> files;
  for (const auto& [file, data] : inputs) {
    std::set<std::string> taken;
    std::vector<std::string> names;
    for (const std::string& title : data->names) names.push_back(free_name(title, taken));
    std::vector<bbsim_hdf5_input_column> columns;
    for (std::size_t c = 0; c < names.size(); ++c) {
      columns.push_back({data->names[c].c_str(), names[c].c_str(), data->columns[c].data()});
    }
    const std::string name = free_name(last_part(file), files);
    const char* const read_as = file.c_str();
    const std::size_t rows = data->columns.empty() ? 0 : data->columns[0].size();
    call([&](auto* error) {
      return module_.write_input(writer_.get(), name.c_str(), read_as, columns.data(),
                                 columns.size(), rows, error);
    });
  }
}

void Hdf5Output::finish(const Attributes& attributes) {
  check_open();
  std::vector<bbsim_hdf5_attribute> pairs;
  pairs.reserve(attributes.size());
  for (const auto& [name, value] : attributes) pairs.push_back(described(name, value));
  call([&](auto* error) {
    return module_.finish(writer_.get(), pairs.data(), pairs.size(), error);
  });
  writer_.reset();
  file_.commit();
}

void require_hdf5(const std::string& target) {
  static_cast<void>(module_to_write(target));
}

void Hdf5Output::check_open() const {
  if (writer_ != nullptr) return;
  throw OutputError("cannot write " + target_ + ": it is complete, or one of its parts failed");
}

void Hdf5Output::fail(const bbsim_hdf5_error& error) {
  writer_.reset();  // an incomplete file must not get its final name
  if (error.system_error != 0) file_.fail(error.system_error);
  throw OutputError("cannot write " + target_ + ": " + error.text);
}

}  // namespace bbsim::file
