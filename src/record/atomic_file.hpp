// A file that appears whole under its final name, or not at all.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>

namespace bbsim::record {

// What is written goes to a hidden temporary in the target's own folder, which commit() renames
// to the target; destroyed without commit(), the temporary is removed and a file that was there
// before is left as it was. A symbolic link stays and the file that it points to is replaced. A
// new file gets the permissions that the umask leaves; a replaced one keeps its own. There is no
// fsync: this guards against failures of the program and the disk, not of the power supply.
//
// What is no regular file (a device, a FIFO, "-" for standard output, /dev/stdout and any other
// name of an open descriptor) is written to directly: renaming over it would destroy it.
//
// Every function throws OutputError, with the target's name, the reason, and what to do about it.
class AtomicFile {
 public:
  // Fails here, before any work is done, if the target cannot be written to.
  explicit AtomicFile(const std::string& target);
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

  // Puts the file under its final name. Nothing may be written afterwards.
  void commit();

  // For a library that does the writing itself. Open for reading, too, if not a device or pipe.
  [[nodiscard]] int descriptor() const { return descriptor_; }

  // Throws the OutputError for an errno that writing to descriptor() met.
  [[noreturn]] void fail(int error_number) const;

  // Bytes. Larger ones only cost page faults; smaller ones, calls of write().
  static constexpr std::size_t buffer_size = 32768;

 private:
  void open_direct(const char* path);
  void open_duplicate(int descriptor);
  void open_temporary(const std::string& path);
  void flush();
  void write_through(std::string_view bytes);
  [[nodiscard]] char* buffer_end() const { return buffer_.get() + buffer_size; }

  std::string name_;       // as the user wrote it, for messages
  std::string path_;       // what name_ stands for once symbolic links are followed
  std::string temporary_;  // empty if there is none to remove
  int descriptor_ = -1;
  std::unique_ptr<char[]> buffer_;
  char* end_;  // of what is in the buffer
};

// The whole of a file in one go; "-" is standard output. Throws OutputError.
void write_file(const std::string& target, std::string_view content);

// "no space left on device": the system's text for an errno, to stand within a sentence.
[[nodiscard]] std::string error_text(int error_number);

// True if the name stands for a device, a pipe or an open descriptor, or is "-": what AtomicFile
// writes to directly.
[[nodiscard]] bool is_written_directly(const std::string& target);

}  // namespace bbsim::record
