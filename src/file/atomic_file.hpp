// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Writes a file that appears whole under its final name, or not at all.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>

#include "file/descriptor.hpp"
#include "file/target.hpp"

namespace bbsim::file {

// Whether a committed file survives a power cut. Syncing to the disk takes time.
enum class Durable { no, yes };

// Writes to a hidden temporary beside the target; commit() renames it. If the process ends earlier,
// an old file stays unchanged. The destructor removes the temporary, or remove_temporaries() at a
// signal; after SIGKILL it stays. commit() keeps a symbolic link and replaces the file that it
// points to. A new file gets its permissions from the umask; a replaced file keeps its own.
//
// A target that is not a regular file is written directly: a device, a FIFO, "-" for standard
// output, /dev/stdout and other names of open descriptors.
//
// Every function throws OutputError with the target's name, the reason, and the remedy.
class AtomicFile {
 public:
  // Throws before any work is done if the target cannot be written.
  explicit AtomicFile(const std::string& target, Durable durable = Durable::no);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  void write(std::string_view bytes);

  // Returns room for at least `size` more bytes; `size` is at most buffer_size. After writing
  // there, call advance() with the end of the bytes.
  char* reserve(std::size_t size) {
    if (static_cast<std::size_t>(buffer_end() - end_) < size) flush();
    return end_;
  }
  void advance(char* end) { end_ = end; }

  // Passes all buffered bytes to the system. A target that is written directly then has them.
  void flush();

  // Puts the file under its final name. Do not write afterwards.
  void commit();

  // For a library that writes the file itself: the temporary's name, empty if the target is written
  // directly.
  [[nodiscard]] const std::string& temporary() const { return temporary_; }

  // Throws the OutputError for an errno from that library's writing.
  [[noreturn]] void fail(int error_number) const { fail_to_write(target_.name, error_number); }

  // Bytes. A larger buffer costs page faults; a smaller one costs more calls of write().
  static constexpr std::size_t buffer_size = 32768;

 private:
  void open_temporary();
  void remove_temporary();
  void write_through(std::string_view bytes);
  [[nodiscard]] char* buffer_end() const { return buffer_.get() + buffer_size; }

  Target target_;
  Durable durable_;
  std::string temporary_;  // its name; empty if there is none
  Descriptor descriptor_;
  off_t size_ = 0;
  Flusher flusher_;  // of a durable file
  std::unique_ptr<char[]> buffer_;
  char* end_;  // end of the bytes in the buffer
};

// Writes a whole file; "-" is standard output. Throws OutputError.
void write_file(const std::string& target, std::string_view content);

}  // namespace bbsim::file
