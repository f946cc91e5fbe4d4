/* Faults in the system calls that write files, for tests: LD_PRELOAD in front of the C library.
 *
 * TYNDALL_FAULT_AT=n   the n-th call of write, fsync, fdatasync and rename (from 1) on files of our own fails
 * TYNDALL_FAULT=kill   the process is killed in it: a write half done, the others not done at all
 *              =after  the process is killed right after it
 *              =ENOSPC, EIO   it fails with this error, and so do all that follow
 * TYNDALL_FAULT_LOG=f  appends a line with the call's name before the fault
 *
 * Calls on descriptors 0 to 2 and on anything but regular files are left alone. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum kind { NONE, KILL, AFTER, ERROR };

static long at = -1;
static enum kind kind;
static int error;
static int count;

static void start(void) {
    if (at >= 0) return;
    const char *n = getenv("TYNDALL_FAULT_AT"), *what = getenv("TYNDALL_FAULT");
    at = n && what ? atol(n) : 0;
    if (!at) return;
    kind = !strcmp(what, "kill") ? KILL : !strcmp(what, "after") ? AFTER : ERROR;
    error = !strcmp(what, "EIO") ? EIO : ENOSPC;
}

static void note(const char *call) {
    const char *path = getenv("TYNDALL_FAULT_LOG");
    FILE *log = path ? fopen(path, "a") : NULL;
    if (!log) return;
    long kept = at;
    at = 0;
    fprintf(log, "%s\n", call);
    fclose(log);
    at = kept;
}

/* What shall happen to this call. */
static enum kind fault(const char *call) {
    start();
    if (!at) return NONE;
    int n = __sync_add_and_fetch(&count, 1);
    if (n < at || (n > at && kind != ERROR)) return NONE;
    if (n == at) note(call);
    return kind;
}

static int ours(int fd) {
    struct stat s;
    return fd > 2 && !fstat(fd, &s) && (S_ISREG(s.st_mode) || S_ISDIR(s.st_mode));
}

__attribute__((noreturn)) static void die(void) { kill(getpid(), SIGKILL); for (;;) pause(); }

#define REAL(name) ((__typeof__(name) *)dlsym(RTLD_NEXT, #name))

ssize_t write(int fd, const void *bytes, size_t n) {
    switch (ours(fd) ? fault("write") : NONE) {
    case KILL: REAL(write)(fd, bytes, n / 2); die();
    case AFTER: REAL(write)(fd, bytes, n); die();
    case ERROR: errno = error; return -1;
    default: return REAL(write)(fd, bytes, n);
    }
}

#define CALL(name, guard, params, ...)                                  \
    int name params {                                                   \
        switch ((guard) ? fault(#name) : NONE) {                        \
        case KILL: die();                                               \
        case AFTER: REAL(name)(__VA_ARGS__); die();                     \
        case ERROR: errno = error; return -1;                           \
        default: return REAL(name)(__VA_ARGS__);                        \
        }                                                               \
    }

CALL(fsync, ours(fd), (int fd), fd)
CALL(fdatasync, ours(fd), (int fd), fd)
CALL(rename, 1, (const char *from, const char *to), from, to)
