// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A file that appears whole under its final name, or not at all.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>

#include "file/descriptor.hpp"
#include "file/target.hpp"

namespace bbsim::file {

// Whether what is committed survives a power cut, too; that takes the disk's time.
enum class Durable { no, yes };

// What is written goes to a file without a name in the target's own folder, which commit() puts
// under the target's; however the process ends before, nothing stays of it, and a file that was
// there is left as it was. (Where the file system knows no such files, it is a hidden temporary,
// which the destructor removes, and remove_temporaries() at a signal.) A symbolic link stays and
// the file that it points to is replaced. A new file gets the permissions that the umask leaves; a
// replaced one keeps its own.
//
// What is no regular file (a device, a FIFO, "-" for standard output, /dev/stdout and any other
// name of an open descriptor) is written to directly.
//
// Every function throws OutputError, with the target's name, the reason, and what to do about it.
class AtomicFile {
 public:
  // Fails here, before any work is done, if the target cannot be written to.
  explicit AtomicFile(const std::string& target, Durable durable = Durable::no);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  void write(std::string_view bytes);

  // Room for at least `size` more bytes, at most buffer_size; what is put there counts once
  // advance() has been told where it ends.
  char* reserve(std::size_t size) {
    if (static_cast<std::size_t>(buffer_end() - end_) < size) flush();
    return end_;
  }
  void advance(char* end) { end_ = end; }

  // Hands all to the system: what is written directly arrives.
  void flush();

  // Puts the file under its final name. Nothing may be written afterwards.
  void commit();

  // The descriptor is for a library that does the writing itself. It is open for reading, too, if
  // not a device or pipe.
  [[nodiscard]] int descriptor() const { return descriptor_.get(); }

  // Throws the OutputError for an errno that writing to descriptor() met.
  [[noreturn]] void fail(int error_number) const { fail_to_write(target_.name, error_number); }

  // Bytes. Larger ones only cost page faults; smaller ones, calls of write().
  static constexpr std::size_t buffer_size = 32768;

 private:
  void open_temporary();
  [[nodiscard]] bool open_unnamed();
  void open_named();
  [[nodiscard]] bool choose_temporary_name(unsigned attempt);
  void forget_name();
  void replace_target();
  void write_through(std::string_view bytes);
  [[nodiscard]] char* buffer_end() const { return buffer_.get() + buffer_size; }

  Target target_;
  Durable durable_;
  std::string temporary_;  // the name of a hidden temporary; empty if there is none to remove
  Descriptor descriptor_;
  std::unique_ptr<char[]> buffer_;
  char* end_;  // of what is in the buffer
};

// The whole of a file in one go; "-" is standard output. Throws OutputError.
void write_file(const std::string& target, std::string_view content);

}  // namespace bbsim::file
