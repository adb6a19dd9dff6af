#include "record/part_file.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "base/error.hpp"
#include "record/atomic_file.hpp"

namespace bbsim::record {
namespace {

std::string content_of(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

// Where the file is that a link stands for, be it there or not.
std::string behind_links(std::filesystem::path path) {
  constexpr int most_links = 40;
  for (int i = 0; i < most_links && std::filesystem::is_symlink(path); ++i) {
    path = path.parent_path() / std::filesystem::read_symlink(path);
  }
  return path;
}

// Reads a file in pieces; `use` gets each piece and its place, and ends it by returning false.
template <class Use>
void read_pieces(int descriptor, Use use) {
  std::array<char, 65536> buffer;
  off_t place = 0;
  for (;;) {
    const ssize_t size = pread(descriptor, buffer.data(), buffer.size(), place);
    if (size < 0 && errno == EINTR) continue;
    if (size <= 0) return;
    if (!use(std::string_view(buffer.data(), static_cast<std::size_t>(size)), place)) return;
    place += size;
  }
}

// Where the line of that number ends, counted from 0; -1 where there are fewer.
off_t end_of_line(int descriptor, std::size_t number) {
  off_t end = -1;
  std::size_t lines = 0;
  read_pieces(descriptor, [&](std::string_view piece, off_t place) {
    for (std::size_t i = 0; i < piece.size(); ++i) {
      if (piece[i] != '\n' || lines++ < number) continue;
      end = place + static_cast<off_t>(i) + 1;
      return false;
    }
    return true;
  });
  return end;
}

}  // namespace

PartFile::PartFile(const std::string& target, const std::string& plan, const std::string& header,
                   bool resume)
    : target_(behind_links(target)), part_(target_ + ".part"), plan_(target_ + ".plan") {
  if (std::filesystem::is_directory(target_)) {
    throw OutputError("cannot write " + target_ + ": is a directory; choose another name");
  }
  constexpr mode_t any_permissions = 0666;  // the umask takes away what it should
  descriptor_ = ::open(part_.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, any_permissions);
  if (descriptor_ < 0) {
    throw OutputError("cannot write " + part_ + ": " + error_text(errno) +
                      "; write to a folder that is there, and where you may");
  }
  try {
    // Before anything else: the plan of a part belongs to whoever writes to the part.
    if (flock(descriptor_, LOCK_EX | LOCK_NB) != 0) {
      throw InputError(part_ +
                       ": another bbsim is writing to it; wait for its end, or choose "
                       "another name with -o");
    }
    if (std::filesystem::file_size(part_) > 0) {
      check_plan(plan, resume);
    } else {
      AtomicFile file(plan_);
      file.write(plan);
      file.commit();
    }
    take_up(header);
  } catch (...) {
    close(descriptor_);
    throw;
  }
}

// Of a part that was there before.
void PartFile::check_plan(const std::string& plan, bool resume) const {
  if (!resume) {
    throw InputError(part_ +
                     ": found, of a sweep that did not end; add --resume to go on with it, or "
                     "remove it to begin anew");
  }
  if (!std::filesystem::exists(plan_)) {
    throw InputError(part_ + ": found without " + plan_ +
                     ", which would say what it is of; remove it to begin anew");
  }
  if (content_of(plan_) != plan) {
    throw InputError(part_ + ": of another sweep than this one, says " + plan_ +
                     "; allowed with --resume: the same scenario, tables, keys, seed, measures and "
                     "shard, by the same version of bbsim");
  }
}

void PartFile::take_up(const std::string& header) {
  std::size_t lines = 0;
  off_t end = 0;
  std::string first;
  read_pieces(descriptor_, [&](std::string_view piece, off_t place) {
    for (std::size_t i = 0; i < piece.size(); ++i) {
      if (lines == 0 && piece[i] != '\n') first += piece[i];
      if (piece[i] != '\n') continue;
      ++lines;
      end = place + static_cast<off_t>(i) + 1;
    }
    return true;
  });
  if (lines > 0 && first == header) {
    kept_ = lines - 1;
  } else {
    end = 0;
  }
  if (ftruncate(descriptor_, end) != 0) fail("shorten", errno);
  has_lines_ = kept_ > 0;
  if (end == 0) {
    append(header + '\n');
    has_lines_ = false;
  }
}

void PartFile::drop_lines_after(std::size_t lines) {
  if (lines >= kept_) return;
  const off_t end = end_of_line(descriptor_, lines);
  if (end < 0 || ftruncate(descriptor_, end) != 0) fail("shorten", errno);
  kept_ = lines;
  has_lines_ = lines > 0;
}

PartFile::~PartFile() {
  if (descriptor_ < 0) return;
  close(descriptor_);
  if (!has_lines_) discard();
}

void PartFile::append(std::string_view lines) {
  has_lines_ = true;
  while (!lines.empty()) {
    const ssize_t written = ::write(descriptor_, lines.data(), lines.size());
    if (written >= 0) {
      lines.remove_prefix(static_cast<std::size_t>(written));
    } else if (errno != EINTR) {
      fail("write", errno);
    }
  }
}

void PartFile::commit() {
  std::error_code error;
  std::filesystem::rename(part_, target_, error);
  if (error) fail("rename", error.value());
  std::filesystem::remove(plan_, error);
  const int closed = close(descriptor_);  // and unlocked, once the part is gone
  descriptor_ = -1;
  if (closed != 0) fail("write", errno);
}

void PartFile::discard() {
  if (descriptor_ >= 0) close(descriptor_);
  descriptor_ = -1;
  std::error_code ignored;
  std::filesystem::remove(part_, ignored);
  std::filesystem::remove(plan_, ignored);
}

void PartFile::fail(const std::string& doing, int error) const {
  throw OutputError("cannot " + doing + ' ' + part_ + ": " + error_text(error) +
                    "; what it holds can be gone on with by --resume");
}

}  // namespace bbsim::record
