/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * failing_calls [-n NUMBER] [-f FAULT] [-c COUNT] COMMAND...: runs the command and makes its system call
 * number NUMBER fail. It counts the calls that FAULT affects: 1 is the first, 0 none. With -c the number of
 * such calls is written to the file COUNT. The exit status is that of the command, or 128 plus the signal
 * that ended it. It is 77 if the system does not allow calls to be watched.
 *
 *     enospc eio    write, fsync, ftruncate, close, rename and open fail so
 *     fsync nosync  fsync alone fails: of a broken disk (EIO), of a file system without the call (EINVAL)
 *     eintr         read, write and open are interrupted
 *     short         read and write do half of what they were asked
 *     emfile        open, pipe, socketpair, mmap of a file and fork fail so
 *     term int kill the signal comes at the call, of any that is watched
 *
 * Counted are calls that concern the command's own files, in the command itself and its children. These files
 * are those in the working folder, pipes, sockets and standard input and output. Files that the loader, fonts
 * and locales take from the system's folders do not count. The kernel asks this program about each (seccomp's
 * notifications, Linux 5.6). So calls from inside the C library are reached too, with any sanitizer.
 */
#define _GNU_SOURCE /* syscall */
#include <errno.h>
#include <fcntl.h>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <poll.h>
#include <pthread.h>
#include <sched.h>
#include <signal.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/types.h>
#include <sys/uio.h>
#include <sys/wait.h>
#include <unistd.h>

enum {
    CANNOT = 77,
    PIECE = 1 << 16
};

/* ---- the calls ---- */

enum kind {
    READ = 1,
    WRITE = 2,
    OPEN = 4,
    CLOSE = 8,
    SETTLE = 16, /* ftruncate, rename: a full or broken disk refuses these too */
    MAKE = 32,   /* pipe, socketpair, fork */
    MAP = 64,
    SYNC = 128,
    OTHER = 256,
    SIGNALLED = READ | WRITE | OPEN | CLOSE | SETTLE | SYNC | OTHER
};

static const struct call {
    int number;
    enum kind kind;
    int fd, path; /* the index of the argument that is a descriptor, and of the path; -1: none */
} calls[] = {
    {__NR_read, READ, 0, -1},        {__NR_write, WRITE, 0, -1},
    {__NR_readv, READ, 0, -1},       {__NR_writev, WRITE, 0, -1},
    {__NR_pread64, READ, 0, -1},     {__NR_pwrite64, WRITE, 0, -1},
    {__NR_openat, OPEN, -1, 1},      {__NR_close, CLOSE, 0, -1},
    {__NR_fsync, SYNC, 0, -1},       {__NR_ftruncate, SETTLE, 0, -1},
    {__NR_fchmod, OTHER, 0, -1},     {__NR_lseek, OTHER, 0, -1},
    {__NR_mmap, MAP, 4, -1},         {__NR_pipe2, MAKE, -1, -1},
    {__NR_socketpair, MAKE, -1, -1}, {__NR_clone, MAKE, -1, -1},
    {__NR_renameat2, SETTLE, -1, 1}, {__NR_unlinkat, OTHER, -1, 1},
#ifdef __NR_open
    {__NR_open, OPEN, -1, 0},        {__NR_rename, SETTLE, -1, 0},
    {__NR_unlink, OTHER, -1, 0},     {__NR_pipe, MAKE, -1, -1},
    {__NR_fork, MAKE, -1, -1},       {__NR_vfork, MAKE, -1, -1},
#endif
};

enum {
    CALLS = sizeof calls / sizeof *calls
};

static const struct fault {
    const char *name;
    int kinds;
    int error;  /* the error that the call returns; 0: none */
    bool less;  /* it does half                            */
    int signal; /* the signal that the process gets instead; 0: none */
} faults[] = {
    {"none", 0, 0, false, 0},
    {"enospc", WRITE | SETTLE | SYNC | CLOSE | OPEN, ENOSPC, false, 0},
    {"eio", READ | WRITE | SETTLE | SYNC | CLOSE, EIO, false, 0},
    {"fsync", SYNC, EIO, false, 0},
    {"nosync", SYNC, EINVAL, false, 0},
    {"eintr", READ | WRITE | OPEN, EINTR, false, 0},
    {"short", READ | WRITE, 0, true, 0},
    {"emfile", OPEN | MAKE | MAP, EMFILE, false, 0},
    {"term", SIGNALLED, 0, false, SIGTERM},
    {"int", SIGNALLED, 0, false, SIGINT},
    {"kill", SIGNALLED, 0, false, SIGKILL},
};

static struct {
    const struct fault *fault;
    unsigned long at, count;
    const char *count_file;
    char folder[4096];
    pid_t child;
} run = {.fault = faults};

/* ---- the command ---- */

static int
filter_calls(void)
{
    struct sock_filter code[CALLS + 3];
    struct sock_fprog program = {0, code};
    unsigned n = 0;

    code[n++] =
        (struct sock_filter)BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(struct seccomp_data, nr));
    for (unsigned k = 0; k < CALLS; k++)
        code[n++] = (struct sock_filter)BPF_JUMP(
            BPF_JMP | BPF_JEQ | BPF_K, (unsigned)calls[k].number, (unsigned char)(CALLS - k), 0);
    code[n++] = (struct sock_filter)BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW);
    code[n++] = (struct sock_filter)BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_USER_NOTIF);
    program.len = (unsigned short)n;
    if (prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0)
        return -1;
    return (int)syscall(__NR_seccomp, SECCOMP_SET_MODE_FILTER, SECCOMP_FILTER_FLAG_NEW_LISTENER,
                        &program);
}

/* Passes the descriptor of the kernel's notifications to the parent as shared[0] - 1, and waits until the
 * parent has it. The command must not inherit it. No watched call may come before. */
static _Noreturn void
start_command(char **command, volatile int *shared)
{
    shared[0] = filter_calls() + 1;
    while (shared[1] == 0)
        sched_yield();
    execvp(command[0], command);
    fprintf(stderr, "failing_calls: %s: %s\n", command[0], strerror(errno));
    _exit(127);
}

/* ---- the questions ---- */

static const struct call *
call_of(int number)
{
    for (size_t k = 0; k < CALLS; k++)
        if (calls[k].number == number)
            return &calls[k];
    return NULL;
}

static bool
read_memory(pid_t who, uint64_t at, void *to, size_t n, size_t *got)
{
    struct iovec here = {to, n}, there = {(void *)(uintptr_t)at, n};
    ssize_t done = process_vm_readv(who, &here, 1, &there, 1, 0);

    *got = done < 0 ? 0 : (size_t)done;
    return done > 0;
}

/* True for the name of one of the command's own files. */
static bool
is_own(const char *name)
{
    return name[0] != '/' || strncmp(name, run.folder, strlen(run.folder)) == 0 ||
           strcmp(name, "/dev/null") == 0;
}

static bool
concerns(const struct seccomp_notif *ask, const struct call *call)
{
    char path[4096] = "", shown[64];
    size_t got;

    if (call->path >= 0) {
        size_t room =
            4096 - (size_t)(ask->data.args[call->path] % 4096); /* bytes to the end of the page */

        read_memory((pid_t)ask->pid, ask->data.args[call->path], path, room - (room == 4096), &got);
        path[sizeof path - 1] = '\0';
        return is_own(path);
    }
    if (call->fd >= 0) {
        ssize_t n;

        if ((int)ask->data.args[call->fd] ==
            STDERR_FILENO) /* the command must be able to print its message */
            return false;
        snprintf(shown, sizeof shown, "/proc/%d/fd/%d", (int)ask->pid,
                 (int)ask->data.args[call->fd]);
        /* path receives the target of the link: NOLINTNEXTLINE(readability-suspicious-call-argument) */
        n = readlink(shown, path, sizeof path - 1);
        path[n < 0 ? 0 : n] = '\0';
        return n > 0 && is_own(path); /* pipe:[123] and socket:[123] count too */
    }
    if (call->number == __NR_clone) /* a process, not a thread */
        return (ask->data.args[0] & 0x10000 /* CLONE_THREAD */) == 0;
    return true;
}

/* Does half of a read or a write for the command. */
static long
do_half(const struct seccomp_notif *ask, const struct call *call)
{
    static char bytes[PIECE];
    int pidfd = (int)syscall(__NR_pidfd_open, (pid_t)ask->pid, 0), fd;
    size_t n = (size_t)ask->data.args[2] / 2, got;
    struct iovec here = {bytes, 0}, there = {(void *)(uintptr_t)ask->data.args[1], 0};
    long done = -EINTR;

    n = n < PIECE ? n : PIECE;
    fd = pidfd < 0 ? -1 : (int)syscall(__NR_pidfd_getfd, pidfd, (int)ask->data.args[0], 0);
    if (fd < 0)
        goto done;
    if (call->number == __NR_write) {
        if (read_memory((pid_t)ask->pid, ask->data.args[1], bytes, n, &got))
            done = write(fd, bytes, got);
    } else {
        done = read(fd, bytes, n);
        here.iov_len = there.iov_len = done < 0 ? 0 : (size_t)done;
        if (done > 0 && process_vm_writev((pid_t)ask->pid, &here, 1, &there, 1, 0) != done)
            done = -EFAULT;
    }
done:
    if (fd >= 0)
        close(fd);
    if (pidfd >= 0)
        close(pidfd);
    return done;
}

static void
send_answer(int listener, const struct seccomp_notif_resp *say)
{
    if (ioctl(listener, SECCOMP_IOCTL_NOTIF_SEND, say) != 0 && errno != ENOENT)
        perror("failing_calls: answer");
}

/* A read from a pipe may wait until a child of the command has written, and the calls of the child are
 * answered here too. Therefore the read runs in a separate thread. There is at most one such thread, because
 * only one call has the number -n. */
static struct half {
    int listener;
    struct seccomp_notif ask;
} half;

static void *
answer_half(void *unused)
{
    struct seccomp_notif_resp say = {.id = half.ask.id};

    (void)unused;
    if ((say.val = do_half(&half.ask, call_of(half.ask.data.nr))) < 0) {
        say.error = (int)say.val;
        say.val = 0;
    }
    send_answer(half.listener, &say);
    return NULL;
}

static void
answer(int listener, const struct seccomp_notif *ask)
{
    struct seccomp_notif_resp say = {.id = ask->id, .flags = SECCOMP_USER_NOTIF_FLAG_CONTINUE};
    const struct call *call = call_of(ask->data.nr);
    bool halves = call->number == __NR_read || call->number == __NR_write;

    if (((int)call->kind & run.fault->kinds) != 0 && concerns(ask, call) &&
        (!run.fault->less || (halves && ask->data.args[2] > 1)) && ++run.count == run.at) {
        if (run.fault->less) {
            pthread_t thread;

            half = (struct half){listener, *ask};
            if (pthread_create(&thread, NULL, answer_half, NULL) == 0)
                return;
        } else if (run.fault->signal != 0) {
            kill(run.child, run.fault->signal);
        } else {
            say.flags = 0;
            say.error = -run.fault->error;
        }
    }
    send_answer(listener, &say);
}

static void
serve(int listener)
{
    struct pollfd ready = {listener, POLLIN, 0};

    for (;;) {
        struct seccomp_notif ask;

        if (poll(&ready, 1, -1) < 0 && errno != EINTR)
            return;
        if ((ready.revents & POLLIN) == 0) {
            if ((ready.revents & (POLLHUP | POLLERR)) != 0)
                return; /* the command and all its children have ended */
            continue;
        }
        memset(&ask, 0, sizeof ask);
        if (ioctl(listener, SECCOMP_IOCTL_NOTIF_RECV, &ask) == 0)
            answer(listener, &ask);
    }
}

/* ---- start and end ---- */

static const struct fault *
fault_named(const char *name)
{
    for (size_t k = 0; k < sizeof faults / sizeof *faults; k++)
        if (strcmp(faults[k].name, name) == 0)
            return &faults[k];
    fprintf(stderr, "failing_calls: no fault '%s'\n", name);
    exit(2);
}

static void
write_count(void)
{
    FILE *f;

    if (run.count_file == NULL)
        return;
    if ((f = fopen(run.count_file, "w")) == NULL || fprintf(f, "%lu\n", run.count) < 0 ||
        fclose(f) != 0)
        perror(run.count_file);
}

static int
cannot(const char *why)
{
    fprintf(stderr, "failing_calls: %s: %s\n", why, strerror(errno));
    return CANNOT;
}

int
main(int argc, char **argv)
{
    int option, pidfd, listener = -1, status = 0;
    int *shared =
        mmap(NULL, sizeof *shared, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);

    while ((option = getopt(argc, argv, "+n:f:c:")) != -1)
        switch (option) {
        case 'n':
            run.at = strtoul(optarg, NULL, 10);
            break;
        case 'f':
            run.fault = fault_named(optarg);
            break;
        case 'c':
            run.count_file = optarg;
            break;
        default:
            return 2;
        }
    if (optind >= argc || (const void *)(uintptr_t)shared == MAP_FAILED ||
        getcwd(run.folder, sizeof run.folder) == NULL)
        return 2;
    shared[0] = -1;
    if ((run.child = fork()) == 0)
        start_command(argv + optind, shared);
    while (shared[0] < 0)
        sched_yield();
    if (shared[0] == 0) {
        kill(run.child, SIGKILL);
        return cannot("the calls of a command cannot be watched here");
    }
    pidfd = (int)syscall(__NR_pidfd_open, run.child, 0);
    listener = (int)syscall(__NR_pidfd_getfd, pidfd, shared[0] - 1, 0);
    shared[1] = 1;
    if (listener < 0) {
        kill(run.child, SIGKILL);
        return cannot("the command cannot be watched");
    }
    close(pidfd);
    serve(listener);
    while (waitpid(run.child, &status, 0) < 0 && errno == EINTR)
        continue;
    write_count();
    return WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
}
