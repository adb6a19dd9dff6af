// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sweep/series_part.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cstdint>
#include <utility>

#include "base/error.hpp"
#include "base/fnv1a.hpp"
#include "file/own_file.hpp"
#include "file/target.hpp"

namespace bbsim::sweep {
namespace {

constexpr std::size_t most_words_at_once = std::size_t{1} << 17U;  // for checking

// FNV-1a, a word at a time, over the number of the case and its values. It detects a page that was
// never written, and the values of another case.
double check_of(std::size_t number, const double* numbers, std::size_t count) {
  std::uint64_t hash = fnv1a_start ^ number;
  for (std::size_t i = 0; i < count; ++i) hash = fnv1a(hash, numbers[i]);
  return std::bit_cast<double>(hash);
}

}  // namespace

SeriesPart::SeriesPart(std::string name, std::size_t numbers_a_case, int part)
    : name_(std::move(name)), numbers_(numbers_a_case) {
  descriptor_ = std::move(file::open_own_file(name_).descriptor);
  struct stat status {};
  if (fstat(part, &status) != 0) fail("write", errno);
  if (const int error = file::take_after(descriptor_.get(), status)) fail("write", error);
  if (fstat(descriptor_.get(), &status) != 0) fail("look at", errno);
  cases_ = static_cast<std::size_t>(status.st_size) / (words() * sizeof(double));
  flusher_ = file::Flusher(status.st_size);
}

off_t SeriesPart::place_of(std::size_t cases) const {
  return static_cast<off_t>(cases * words() * sizeof(double));
}

// Reads cases into the buffer; returns how many the file has.
std::size_t SeriesPart::read_words(std::size_t first, std::size_t count) const {
  buffer_.resize(count * words());
  const std::size_t size = buffer_.size() * sizeof(double);
  const ssize_t got = file::read_at(descriptor_.get(), reinterpret_cast<char*>(buffer_.data()),
                                    size, place_of(first));
  if (got < 0) fail("read", errno);
  return static_cast<std::size_t>(got) / (words() * sizeof(double));
}

bool SeriesPart::is_sound(std::size_t number, const double* words) const {
  const double check = check_of(number, words, numbers_);
  return std::bit_cast<std::uint64_t>(check) == std::bit_cast<std::uint64_t>(words[numbers_]);
}

std::size_t SeriesPart::count_kept() const {
  const std::size_t at_once = std::max<std::size_t>(1, most_words_at_once / words());
  for (std::size_t first = 0; first < cases_;) {
    const std::size_t count = read_words(first, std::min(at_once, cases_ - first));
    for (std::size_t i = 0; i < count; ++i) {
      if (!is_sound(first + i, buffer_.data() + i * words())) return first + i;
    }
    if (count == 0) return first;
    first += count;
  }
  return cases_;
}

void SeriesPart::keep_only(std::size_t cases) {
  if (ftruncate(descriptor_.get(), place_of(cases)) != 0) fail("shorten", errno);
  cases_ = cases;
  flusher_ = file::Flusher(place_of(cases));
}

void SeriesPart::append(const std::vector<std::vector<double>>& series, std::size_t cases) {
  buffer_.clear();
  buffer_.reserve(cases * words());
  for (std::size_t i = 0; i < cases; ++i) {
    for (const auto& column : series) {
      const std::size_t width = column.size() / cases;
      const auto from = column.begin() + static_cast<std::ptrdiff_t>(i * width);
      buffer_.insert(buffer_.end(), from, from + static_cast<std::ptrdiff_t>(width));
    }
    buffer_.push_back(check_of(cases_ + i, buffer_.data() + i * words(), numbers_));
  }
  const std::string_view bytes(reinterpret_cast<const char*>(buffer_.data()),
                               buffer_.size() * sizeof(double));
  if (const int error = file::write_all(descriptor_.get(), bytes)) fail("write", error);
  cases_ += cases;
  const off_t size = place_of(cases_);
  const int error = flusher_.perform(flusher_.due(size), descriptor_.get(), size);
  if (error != 0) fail("sync", error);
}

void SeriesPart::sync() {
  const int error = flusher_.perform(file::Flusher::Due::sync, descriptor_.get(), place_of(cases_));
  if (error != 0) fail("sync", error);
}

void SeriesPart::read(std::size_t first, std::size_t count, std::vector<double>& numbers) const {
  const std::size_t got = read_words(first, count);
  numbers.resize(count * numbers_);
  for (std::size_t i = 0; i < count; ++i) {
    const double* const words = buffer_.data() + i * this->words();
    if (i >= got || !is_sound(first + i, words)) {
      throw OutputError("cannot read " + name_ + ": the trajectories of row " +
                        std::to_string(first + i + 1) + " are not as they were written");
    }
    std::copy_n(words, numbers_, numbers.begin() + static_cast<std::ptrdiff_t>(i * numbers_));
  }
}

void SeriesPart::remove() const {
  file::remove_own_file(name_, descriptor_.get());
}

void SeriesPart::fail(const std::string& doing, int error) const {
  throw OutputError("cannot " + doing + ' ' + name_ + ": " + file::error_text(error));
}

}  // namespace bbsim::sweep
