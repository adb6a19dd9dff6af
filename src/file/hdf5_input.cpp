// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "file/hdf5_input.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cstdint>
#include <new>
#include <stdexcept>
#include <utility>

#include "base/error.hpp"
#include "base/shown.hpp"
#include "file/descriptor.hpp"

namespace bbsim::file {
namespace {

using hdf5::Head;
using hdf5::Message;
using hdf5::Packer;
using hdf5::Unpacker;

[[noreturn]] void nonsense() {
  throw Hdf5Trouble("the HDF5 reader sent an unexpected answer: the file is damaged");
}

bbsim_hdf5_kind kind_of(std::uint64_t number) {
  if (number > BBSIM_HDF5_AXIS) nonsense();
  return static_cast<bbsim_hdf5_kind>(number);
}

AttributeValue value_of(Unpacker& message) {
  switch (message.number()) {
    case 0:
      return std::string(message.text());
    case 1:
      return std::bit_cast<double>(message.number());
    default:
      return static_cast<std::int64_t>(message.number());
  }
}

// Runs `action`, with all that can go wrong in it as an InputError about the file.
template <class Action>
void guarded(const Hdf5Input& input, Action action) {
  try {
    action();
  } catch (const InputError&) {
    throw;
  } catch (const std::bad_alloc&) {
    input.fail("there is not enough memory for its content");
  } catch (const std::length_error&) {
    input.fail("there is not enough memory for its content");
  } catch (const std::runtime_error& error) {  // Hdf5Trouble, or of a message that makes no sense
    input.fail(error.what());
  }
}

}  // namespace

Hdf5Input::Hdf5Input(const std::string& file) : file_(file) {
  struct stat status {};
  if (stat(file.c_str(), &status) != 0 || access(file.c_str(), R_OK) != 0) fail(error_text(errno));
  if (!S_ISREG(status.st_mode)) fail("it is no regular file");
  guarded(*this, [this] {
    process_ = Hdf5Process::running();
    try {
      open();
    } catch (const Hdf5Trouble&) {
      if (!process_->ended_idle()) throw;  // just when it was asked
      process_ = Hdf5Process::running();
      open();
    }
  });
}

Hdf5Input::~Hdf5Input() {
  if (!is_open_) return;
  try {
    Hdf5Talk(*process_, Message::close, Packer().number(number_).bytes()).over();
  } catch (const std::exception&) {  // it has ended, and knows of no file any more
  }
}

std::size_t Hdf5Input::root_datasets() const {
  return inputs_.empty() ? datasets_.size() : inputs_.front().first;
}

void Hdf5Input::open() {
  datasets_.clear();
  inputs_.clear();
  attributes_.clear();
  Hdf5Talk talk(*process_, Message::open, Packer().text(file_).bytes());
  for (;;) {
    const Head head = talk.next();
    const std::string message = talk.bytes(head);
    switch (head.what) {
      case Message::dataset:
        add_dataset(message);
        break;
      case Message::attribute:
        add_attribute(message);
        break;
      case Message::input:
        inputs_.push_back({message, datasets_.size(), 0});
        break;
      case Message::opened:
        number_ = Unpacker(message).number();
        is_open_ = true;
        talk.over();
        return;
      default:
        nonsense();
    }
  }
}

void Hdf5Input::add_dataset(const std::string& message) {
  Unpacker part(message);
  Hdf5Dataset dataset;
  dataset.kind = kind_of(part.number());
  dataset.width = part.number();
  dataset.rows = part.number();
  dataset.name = part.text();
  dataset.unit = part.text();
  dataset.description = part.text();
  datasets_.push_back(std::move(dataset));
  if (!inputs_.empty()) ++inputs_.back().count;
}

void Hdf5Input::add_attribute(const std::string& message) {
  Unpacker part(message);
  std::string name(part.text());
  attributes_.emplace_back(std::move(name), value_of(part));
}

void Hdf5Input::read(std::size_t first, std::size_t rows,
                     std::span<const Hdf5Wanted> wanted) const {
  guarded(*this, [&] {
    Packer request;
    request.number(number_).number(first).number(rows);
    for (const Hdf5Wanted& one : wanted) request.number(one.dataset);
    Hdf5Talk talk(*process_, Message::read, request.bytes());
    for (const Hdf5Wanted& one : wanted) {
      const Hdf5Dataset& dataset = datasets_.at(one.dataset);
      if (dataset.kind == BBSIM_HDF5_TEXT) {
        take_texts(talk, rows, *one.texts);
      } else {
        take_numbers(talk, dataset, rows, *one.numbers);
      }
    }
    if (talk.next().what != Message::done) nonsense();
    talk.over();
  });
}

void Hdf5Input::take_numbers(Hdf5Talk& talk, const Hdf5Dataset& dataset, std::size_t rows,
                             std::vector<double>& numbers) const {
  const std::size_t width = dataset.kind == BBSIM_HDF5_SERIES ? dataset.width : 1;
  numbers.clear();
  try {
    if (width != 0 && rows > numbers.max_size() / width) throw std::length_error("");
    numbers.reserve(rows * width);
  } catch (const std::exception&) {  // bad_alloc or length_error
    fail("no memory for the " + std::to_string(rows) + " rows of dataset " + shown(dataset.name));
  }
  while (numbers.size() < rows * width) {
    const Head head = talk.next();
    const std::size_t count = head.bytes / sizeof(double);
    const std::size_t missing = rows * width - numbers.size();
    if (head.what != Message::numbers || count == 0 || count > missing ||
        head.bytes % sizeof(double) != 0) {
      nonsense();
    }
    const std::size_t place = numbers.size();
    numbers.resize(place + count);
    talk.bytes(head, &numbers[place]);
  }
}

void Hdf5Input::take_texts(Hdf5Talk& talk, std::size_t rows,
                           std::vector<std::string>& texts) const {
  texts.clear();
  while (texts.size() < rows) {
    const Head head = talk.next();
    if (head.what != Message::texts || head.bytes == 0) nonsense();
    const std::string message = talk.bytes(head);
    for (Unpacker part(message); !part.empty();) {
      if (texts.size() == rows) nonsense();
      texts.emplace_back(part.text());
    }
  }
}

void Hdf5Input::fail(std::string_view reason) const {
  throw InputError("cannot read " + shown(file_, uncut) + ": " + std::string(reason));
}

}  // namespace bbsim::file
