// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Preloaded into a program (LD_PRELOAD), makes the K-th system call of a given name fail, counted
// from the beginning of main() to its end. scripts/try-failing-calls compiles this and selects the
// failure through the environment:
//
//   FAIL_PROGRAM  name of the started program; others, such as its children, are left alone
//   FAIL_CALL     name of the call
//   FAIL_AT       which call fails, from 1; 0: none, calls are only counted
//   FAIL_WITH     name of an error, such as EIO; SHORT: half of the bytes are transferred
//   FAIL_ON       if set, all later calls of that name fail too
//   FAIL_REPORT   a file: gets "fired" when a call fails; if FAIL_AT=0, lines CALL NUMBER at the end
//
// Writes to standard error never fail, because the messages are examined. Calls inside the C
// library, such as those of fwrite, are not intercepted.
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <link.h>
#include <pthread.h>
#include <spawn.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <unistd.h>

// clang-format off
#define ALL_CALLS(X)                                                                            \
  X(open) X(openat) X(fopen) X(fdopen) X(read) X(pread) X(readv) X(write) X(pwrite) X(writev)   \
  X(send) X(fsync) X(fdatasync) X(sync_file_range) X(rename) X(unlink) X(close) X(ftruncate)    \
  X(stat) X(lstat) X(fstat) X(fchmod) X(fchown) X(flock) X(fcntl) X(faccessat) X(readlink)      \
  X(malloc) X(calloc) X(realloc) X(aligned_alloc)                                               \
  X(posix_spawn) X(pthread_create) X(socketpair) X(pipe2) X(dlopen)
// clang-format on

#define NAMED(name) call_##name,
enum call { ALL_CALLS(NAMED) number_of_calls };
#define TEXT(name) #name,
static const char* const call_names[] = {ALL_CALLS(TEXT)};

static atomic_bool counting;
static atomic_long made[number_of_calls];
static const char* report;
static int failing = -1;  // index of the call; -1: only count
static long fails_at;
static bool fails_on, halves;
static int error_number;

// Avoids functions that may be made to fail.
static void say(const char* text) {
  const long file = syscall(SYS_openat, AT_FDCWD, report, O_WRONLY | O_CREAT | O_APPEND, 0666);
  syscall(SYS_write, file, text, strlen(text));
  syscall(SYS_close, file);
}

// Whether this call must fail; errno is then the error. Otherwise errno is kept.
static bool fails(enum call call) {
  if (!atomic_load(&counting)) return false;
  const long number = atomic_fetch_add(&made[call], 1) + 1;
  if ((int)call != failing || number < fails_at || (number > fails_at && !fails_on)) return false;
  if (number == fails_at) say("fired\n");
  errno = error_number;
  return true;
}

static int number_of(const char* name) {
  static const struct {
    const char* name;
    int number;
  } errors[] = {{"EACCES", EACCES}, {"EAGAIN", EAGAIN}, {"EINTR", EINTR},   {"EINVAL", EINVAL},
                {"EIO", EIO},       {"EMFILE", EMFILE}, {"ENOLCK", ENOLCK}, {"ENOMEM", ENOMEM},
                {"ENOSPC", ENOSPC}, {"EPERM", EPERM},   {"EPIPE", EPIPE},   {"EXDEV", EXDEV}};
  for (size_t i = 0; i < sizeof errors / sizeof errors[0]; ++i) {
    if (strcmp(errors[i].name, name) == 0) return errors[i].number;
  }
  say("unknown FAIL_WITH\n");
  _exit(99);
}

static void set_up(void) {
  const char* program = getenv("FAIL_PROGRAM");
  const char* call = getenv("FAIL_CALL");
  const char* at = getenv("FAIL_AT");
  const char* with = getenv("FAIL_WITH");
  report = getenv("FAIL_REPORT");
  if (!program || !at || !report || strcmp(program, program_invocation_short_name) != 0) return;
  fails_at = atol(at);
  fails_on = getenv("FAIL_ON") != NULL;
  if (fails_at > 0 && call && with) {
    for (int i = 0; i < number_of_calls; ++i) {
      if (strcmp(call_names[i], call) == 0) failing = i;
    }
    if (failing < 0) say("unknown FAIL_CALL\n");
    halves = strcmp(with, "SHORT") == 0;
    error_number = halves ? 0 : number_of(with);
  }
  atomic_store(&counting, true);
}

static int (*real_main)(int, char**, char**);
static int counted_main(int count, char** arguments, char** environment) {
  set_up();
  return real_main(count, arguments, environment);
}

int __libc_start_main(int (*program)(int, char**, char**), int count, char** arguments,
                      void (*init)(void), void (*fini)(void), void (*rtld_fini)(void), void* end);
int __libc_start_main(int (*program)(int, char**, char**), int count, char** arguments,
                      void (*init)(void), void (*fini)(void), void (*rtld_fini)(void), void* end) {
  const __typeof__(&__libc_start_main) start = dlsym(RTLD_NEXT, "__libc_start_main");
  real_main = program;
  return start(counted_main, count, arguments, init, fini, rtld_fini, end);
}

__attribute__((destructor)) static void say_counts(void) {
  if (!atomic_exchange(&counting, false) || failing >= 0) return;
  for (int i = 0; i < number_of_calls; ++i) {
    if (!made[i]) continue;
    char line[80];
    snprintf(line, sizeof line, "%s %ld\n", call_names[i], (long)made[i]);
    say(line);
  }
}

// NEXT(name): the real function; looked up once, not counted.
static void* next(void* _Atomic* place, const char* name) {
  void* found = atomic_load(place);
  if (found) return found;
  const bool was = atomic_exchange(&counting, false);
  found = dlsym(RTLD_NEXT, name);
  atomic_store(&counting, was);
  atomic_store(place, found);
  return found;
}
#define NEXT(name)            \
  static void* _Atomic known; \
  const __typeof__(&name) next_function = (__typeof__(&name))next(&known, #name)

// CALL(result, name, counted as, value at failure, parameters, arguments)
#define CALL(result, name, as, failed, parameters, arguments) \
  result name parameters {                                    \
    NEXT(name);                                               \
    if (fails(call_##as)) return failed;                      \
    return next_function arguments;                           \
  }

static size_t at_most(size_t bytes) {
  return bytes > 1 ? bytes / 2 : bytes;
}
// The same for calls that transfer bytes; writes to standard error never fail.
#define TRANSFER(name, parameters, file, size, arguments) \
  ssize_t name parameters {                               \
    NEXT(name);                                           \
    if ((file) != STDERR_FILENO && fails(call_##name)) {  \
      if (!halves) return -1;                             \
      size = at_most(size);                               \
    }                                                     \
    return next_function arguments;                       \
  }

TRANSFER(read, (int file, void* to, size_t size), file, size, (file, to, size))
TRANSFER(pread, (int file, void* to, size_t size, off_t place), file, size, (file, to, size, place))
TRANSFER(write, (int file, const void* from, size_t size), file, size, (file, from, size))
TRANSFER(pwrite, (int file, const void* from, size_t size, off_t place), file, size,
         (file, from, size, place))
TRANSFER(send, (int file, const void* from, size_t size, int flags), file, size,
         (file, from, size, flags))
CALL(ssize_t, readv, readv, -1, (int file, const struct iovec* parts, int count),
     (file, parts, count))
ssize_t writev(int file, const struct iovec* parts, int count) {
  NEXT(writev);
  if (file != STDERR_FILENO && fails(call_writev)) {
    if (!halves) return -1;
    return write(file, parts[0].iov_base, at_most(parts[0].iov_len));
  }
  return next_function(file, parts, count);
}

static mode_t mode_of(int how, va_list list) {
  return how & O_CREAT ? va_arg(list, mode_t) : 0;
}
#define OPENING(name, as, parameters, arguments) \
  int name parameters {                          \
    NEXT(name);                                  \
    va_list list;                                \
    va_start(list, how);                         \
    const mode_t mode = mode_of(how, list);      \
    va_end(list);                                \
    if (fails(call_##as)) return -1;             \
    return next_function arguments;              \
  }
OPENING(open, open, (const char* name, int how, ...), (name, how, mode))
OPENING(open64, open, (const char* name, int how, ...), (name, how, mode))
OPENING(openat, openat, (int folder, const char* name, int how, ...), (folder, name, how, mode))
OPENING(openat64, openat, (int folder, const char* name, int how, ...), (folder, name, how, mode))
CALL(FILE*, fopen, fopen, NULL, (const char* name, const char* how), (name, how))
CALL(FILE*, fopen64, fopen, NULL, (const char* name, const char* how), (name, how))
CALL(FILE*, fdopen, fdopen, NULL, (int file, const char* how), (file, how))

// Closes the descriptor even if the call must fail.
int close(int file) {
  NEXT(close);
  if (!fails(call_close)) return next_function(file);
  next_function(file);
  errno = error_number;
  return -1;
}

// Only the commands that create a descriptor.
int fcntl(int file, int command, ...) {
  NEXT(fcntl);
  va_list list;
  va_start(list, command);
  void* const argument = va_arg(list, void*);
  va_end(list);
  if ((command == F_DUPFD || command == F_DUPFD_CLOEXEC) && fails(call_fcntl)) return -1;
  return next_function(file, command, argument);
}

CALL(int, fsync, fsync, -1, (int file), (file))
CALL(int, fdatasync, fdatasync, -1, (int file), (file))
CALL(int, sync_file_range, sync_file_range, -1,
     (int file, off64_t place, off64_t size, unsigned flags), (file, place, size, flags))
CALL(int, rename, rename, -1, (const char* from, const char* to), (from, to))
CALL(int, unlink, unlink, -1, (const char* name), (name))
CALL(int, ftruncate, ftruncate, -1, (int file, off_t size), (file, size))
CALL(int, stat, stat, -1, (const char* name, struct stat* status), (name, status))
CALL(int, lstat, lstat, -1, (const char* name, struct stat* status), (name, status))
CALL(int, fstat, fstat, -1, (int file, struct stat* status), (file, status))
CALL(int, fstat64, fstat, -1, (int file, struct stat64* status), (file, status))
CALL(int, fchmod, fchmod, -1, (int file, mode_t mode), (file, mode))
CALL(int, fchown, fchown, -1, (int file, uid_t user, gid_t group), (file, user, group))
int flock(int file, int how);
CALL(int, flock, flock, -1, (int file, int how), (file, how))
CALL(int, faccessat, faccessat, -1, (int folder, const char* name, int how, int flags),
     (folder, name, how, flags))
CALL(ssize_t, readlink, readlink, -1, (const char* name, char* to, size_t size), (name, to, size))
CALL(int, socketpair, socketpair, -1, (int domain, int type, int protocol, int ends[2]),
     (domain, type, protocol, ends))
CALL(int, pipe2, pipe2, -1, (int ends[2], int flags), (ends, flags))
// After a failure dlerror must give a reason; after a success the libraries' constructors run.
void* dlopen(const char* name, int how) {
  NEXT(dlopen);
  if (fails(call_dlopen)) return next_function("/nowhere/that/does/not/open.so", how);
  const bool was = atomic_exchange(&counting, false);
  void* const library = next_function(name, how);
  atomic_store(&counting, was);
  return library;
}
// These return the error number instead of setting errno.
CALL(int, posix_spawn, posix_spawn, error_number,
     (pid_t * process, const char* program, const posix_spawn_file_actions_t* actions,
      const posix_spawnattr_t* attributes, char* const arguments[], char* const environment[]),
     (process, program, actions, attributes, arguments, environment))
CALL(int, pthread_create, pthread_create, error_number,
     (pthread_t * thread, const pthread_attr_t* attributes, void* (*function)(void*),
      void* argument),
     (thread, attributes, function, argument))

// Uses the C library's internal names, because looking up a name allocates memory.
void* __libc_malloc(size_t size);
void* __libc_calloc(size_t count, size_t size);
void* __libc_realloc(void* memory, size_t size);
void* __libc_memalign(size_t alignment, size_t size);

// Other libraries, such as HDF5, may crash without memory.
static bool is_ours(void* caller) {
  struct dl_find_object found;
  if (_dl_find_object(caller, &found) != 0) return false;
  const char* const name = found.dlfo_link_map->l_name;
  return *name == '\0' || strstr(name, "/libc.so") || strstr(name, "/libbbsim");
}
#define NO_MEMORY(name) \
  (atomic_load(&counting) && is_ours(__builtin_return_address(0)) && fails(call_##name))
void* malloc(size_t size) {
  return NO_MEMORY(malloc) ? NULL : __libc_malloc(size);
}
// The C library's would call malloc on behalf of any library.
char* strdup(const char* text) {
  const size_t size = strlen(text) + 1;
  char* const copy = NO_MEMORY(malloc) ? NULL : __libc_malloc(size);
  return copy ? memcpy(copy, text, size) : NULL;
}
void* calloc(size_t count, size_t size) {
  return NO_MEMORY(calloc) ? NULL : __libc_calloc(count, size);
}
void* realloc(void* memory, size_t size) {
  return NO_MEMORY(realloc) ? NULL : __libc_realloc(memory, size);
}
void* aligned_alloc(size_t alignment, size_t size) {
  return fails(call_aligned_alloc) ? NULL : __libc_memalign(alignment, size);
}
