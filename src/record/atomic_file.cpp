#include "record/atomic_file.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <system_error>

#include "base/error.hpp"

namespace bbsim::record {
namespace {

// N of "-" (1), /proc/self/fd/N and /dev/fd/N: a descriptor of this process. Opening such a name
// again would lose the position of what the shell has redirected to a file.
std::optional<int> own_descriptor(std::string_view path) {
  if (path == "-") return STDOUT_FILENO;
  for (std::string_view folder : {"/proc/self/fd/", "/dev/fd/"}) {
    if (!path.starts_with(folder)) continue;
    int number = 0;
    const char* end = path.data() + path.size();
    const auto [stop, error] = std::from_chars(path.data() + folder.size(), end, number);
    if (error == std::errc() && stop == end && number >= 0) return number;
  }
  return std::nullopt;
}

// The name behind the symbolic links, which may not exist yet; stops at a descriptor's name
// (/dev/stdout is a link to one). Sets errno and returns nothing if it cannot be told.
std::optional<std::string> follow_links(const std::string& name) {
  std::filesystem::path path = name;
  constexpr int most_links = 40;  // as many as Linux follows
  for (int links = 0; links <= most_links; ++links) {
    struct stat status {};
    if (own_descriptor(path.native())) return path;
    if (lstat(path.c_str(), &status) != 0) {
      if (errno == ENOENT) return path;
      return std::nullopt;
    }
    if (!S_ISLNK(status.st_mode)) return path;
    std::error_code error;
    const std::filesystem::path link = std::filesystem::read_symlink(path, error);
    if (error) {
      errno = error.value();
      return std::nullopt;
    }
    path = path.parent_path() / link;  // an absolute link replaces what stands before it
  }
  errno = ELOOP;
  return std::nullopt;
}

std::string folder_of(const std::string& path) {
  const std::string folder = std::filesystem::path(path).parent_path();
  return folder.empty() ? "." : folder;
}

// Short, whatever the target is called, so that it cannot exceed the longest name allowed.
std::string temporary_name(unsigned attempt) {
  const auto now = std::chrono::steady_clock::now().time_since_epoch().count();
  char text[64];
  const int size = std::snprintf(text, sizeof text, ".bbsim-%lx-%llx-%x.tmp",
                                 static_cast<unsigned long>(getpid()),
                                 static_cast<unsigned long long>(now), attempt);
  return {text, static_cast<std::size_t>(size)};
}

// 0 to 2 are where messages go: a file that got one of them, because the program was started
// with it closed, would be written into by accident.
int above_standard_streams(int descriptor) {
  if (descriptor < 0 || descriptor > STDERR_FILENO) return descriptor;
  const int higher = fcntl(descriptor, F_DUPFD_CLOEXEC, STDERR_FILENO + 1);
  const int error = errno;
  close(descriptor);
  errno = error;
  return higher;
}

// Lets two files change their names in one step, which is as good as a rename: ext4, asked to
// rename over a file, starts to write to the disk there and then, which takes longer than a
// common run of the whole program. False if `path` is no file or the system cannot do it.
bool exchange(const std::string& temporary, const std::string& path) {
  struct stat status {};
  return lstat(path.c_str(), &status) == 0 && S_ISREG(status.st_mode) &&
         renameat2(AT_FDCWD, temporary.c_str(), AT_FDCWD, path.c_str(), RENAME_EXCHANGE) == 0;
}

std::string advice(int error_number, const std::string& path) {
  switch (error_number) {
    case ENOSPC:
    case EDQUOT:
      return "; free some, or write to another place";
    case EFBIG:
      return "; the limit is the file system's, or that of ulimit -f";
    case EACCES:
    case EPERM:
    case EROFS:
      return "; write to a place where you may, or change the permissions of " + path;
    case ENAMETOOLONG:
      return "; choose a shorter one";
    default:
      return "";
  }
}

}  // namespace

std::string error_text(int error_number) {
  std::string text = std::generic_category().message(error_number);
  if (!text.empty() && text[0] >= 'A' && text[0] <= 'Z') {
    text[0] = static_cast<char>(text[0] - 'A' + 'a');
  }
  return text;
}

bool is_written_directly(const std::string& target) {
  if (own_descriptor(target)) return true;
  if (const auto path = follow_links(target); path && own_descriptor(*path)) return true;
  struct stat status {};
  return stat(target.c_str(), &status) == 0 && !S_ISREG(status.st_mode) && !S_ISDIR(status.st_mode);
}

AtomicFile::AtomicFile(const std::string& target)
    : name_(target == "-" ? "standard output" : target),
      // Left uninitialised on purpose: its pages cost nothing before they are written to.
      buffer_(new char[buffer_size]),
      end_(buffer_.get()) {
  if (target.empty()) throw OutputError("cannot write: the file's name is empty");
  if (const auto number = own_descriptor(target)) {
    open_duplicate(*number);
    return;
  }

  // Following the links is left to the system first, so that its own rules about them hold.
  struct stat status {};
  const bool exists = stat(target.c_str(), &status) == 0;
  if (!exists && errno != ENOENT) fail(errno);
  if (exists && S_ISDIR(status.st_mode)) fail(EISDIR);

  const std::optional<std::string> path = follow_links(target);
  if (!path) fail(errno);
  if (const auto number = own_descriptor(*path)) {
    open_duplicate(*number);
    return;
  }
  if (exists && !S_ISREG(status.st_mode)) {
    open_direct(target.c_str());
    return;
  }

  path_ = *path;
  if (std::filesystem::path(path_).filename().empty()) fail(EISDIR);
  // A rename would replace a write-protected file; whoever protected it did not mean that.
  if (exists && faccessat(AT_FDCWD, path_.c_str(), W_OK, AT_EACCESS) != 0) fail(errno);
  open_temporary(path_);
  if (!exists) return;
  // Another's file stays theirs where the system allows it. Mode last: chown clears parts of it.
  constexpr mode_t all_permissions = 07777;
  if (status.st_uid != geteuid() || status.st_gid != getegid()) {
    [[maybe_unused]] const int ignored = fchown(descriptor_, status.st_uid, status.st_gid);
  }
  if (fchmod(descriptor_, status.st_mode & all_permissions) != 0) {
    const int error = errno;  // no destructor runs for a constructor that throws
    close(descriptor_);
    unlink(temporary_.c_str());
    fail(error);
  }
}

AtomicFile::~AtomicFile() {
  if (descriptor_ >= 0) close(descriptor_);
  if (!temporary_.empty()) unlink(temporary_.c_str());
}

void AtomicFile::open_direct(const char* path) {
  descriptor_ = above_standard_streams(open(path, O_WRONLY | O_CLOEXEC | O_NOCTTY));
  if (descriptor_ < 0) fail(errno);
}

void AtomicFile::open_duplicate(int descriptor) {
  // A duplicate can be closed, and so tell of errors that only closing brings to light.
  descriptor_ = fcntl(descriptor, F_DUPFD_CLOEXEC, STDERR_FILENO + 1);
  if (descriptor_ < 0) fail(errno);
}

void AtomicFile::open_temporary(const std::string& path) {
  const std::string folder = folder_of(path);
  constexpr unsigned most_attempts = 100;
  for (unsigned attempt = 0; attempt < most_attempts; ++attempt) {
    temporary_ = std::filesystem::path(folder) / temporary_name(attempt);
    constexpr mode_t any_permissions = 0666;  // the umask takes away what it should
    descriptor_ = above_standard_streams(
        open(temporary_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, any_permissions));
    if (descriptor_ >= 0) return;
    if (errno != EEXIST) break;
  }
  const int error = errno;
  temporary_.clear();
  if (error == ENOENT) {
    throw OutputError("cannot write " + name_ + ": there is no folder " + folder +
                      "; create it, or write to another place");
  }
  if (error == EACCES || error == EPERM || error == EROFS) {
    throw OutputError("cannot write " + name_ + ": " + error_text(error) + " in folder " + folder +
                      advice(error, "the folder"));
  }
  fail(error);
}

void AtomicFile::write(std::string_view bytes) {
  if (bytes.size() > static_cast<std::size_t>(buffer_end() - end_)) flush();
  if (bytes.size() > buffer_size) {
    write_through(bytes);
    return;
  }
  end_ += bytes.copy(end_, bytes.size());
}

void AtomicFile::flush() {
  const std::string_view content(buffer_.get(), static_cast<std::size_t>(end_ - buffer_.get()));
  end_ = buffer_.get();  // also when writing fails: it is not tried again
  write_through(content);
}

void AtomicFile::write_through(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
    if (written > 0) {
      bytes.remove_prefix(static_cast<std::size_t>(written));
    } else if (written < 0 && errno == EAGAIN) {  // a pipe that someone made non-blocking
      pollfd wait{descriptor_, POLLOUT, 0};
      poll(&wait, 1, -1);
    } else if (written < 0 && errno != EINTR) {
      fail(errno);
    }
  }
}

void AtomicFile::commit() {
  flush();
  const int closed = close(descriptor_);
  descriptor_ = -1;
  if (closed != 0 && errno != EINTR) fail(errno);  // Linux has closed it all the same on EINTR
  if (temporary_.empty()) return;
  if (exchange(temporary_, path_)) {
    unlink(temporary_.c_str());
  } else if (std::rename(temporary_.c_str(), path_.c_str()) != 0) {
    fail(errno);
  }
  temporary_.clear();
}

void AtomicFile::fail(int error_number) const {
  throw OutputError("cannot write " + name_ + ": " + error_text(error_number) +
                    advice(error_number, name_));
}

void write_file(const std::string& target, std::string_view content) {
  AtomicFile file(target);
  file.write(content);
  file.commit();
}

}  // namespace bbsim::record
