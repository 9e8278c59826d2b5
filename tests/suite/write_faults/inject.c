/* Runs a program and makes system calls fail that write below a folder:
 *
 *     inject FOLDER FAULT NUMBER REPORT PROGRAM ARGUMENT...
 *
 * The call of this number, from 1, fails; 0 is none. FAULT is `enospc` (it and all later ones that need space), `eio`,
 * `eintr` (once), or `short` (a write writes half of its bytes). REPORT receives a line for each call: its name and
 * its path. The exit code is the program's. Its child processes are left alone.
 *
 * A tracer, not a preloaded library: the program also makes system calls without the C library. x86-64 only.
 */
#define _GNU_SOURCE
#include <elf.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <signal.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ptrace.h>
#include <sys/syscall.h>
#include <sys/types.h>
#include <sys/uio.h>
#include <sys/user.h>
#include <sys/wait.h>
#include <unistd.h>

enum { MAX_THREADS = 256 };

/* The threads in a system call, and with which error it is to return; 0 if it is left alone. */
static struct {
    pid_t thread;
    int is_inside, error;
} threads[MAX_THREADS];

static const char *folder, *fault;
static long wanted, count;
static FILE *report;

static int slot_of(pid_t thread) {
    int free_slot = -1;
    for (int at = 0; at < MAX_THREADS; at++) {
        if (threads[at].thread == thread)
            return at;
        if (!threads[at].thread && free_slot < 0)
            free_slot = at;
    }
    if (free_slot < 0) {
        fprintf(stderr, "inject: too many threads\n");
        exit(125);
    }
    threads[free_slot].thread = thread;
    threads[free_slot].is_inside = threads[free_slot].error = 0;
    return free_slot;
}

static void path_of_fd(pid_t thread, long fd, char *path) {
    char link[64];
    snprintf(link, sizeof link, "/proc/%d/fd/%ld", thread, fd);
    ssize_t length = readlink(link, path, PATH_MAX - 1);
    path[length < 0 ? 0 : length] = 0;
}

static void path_at(pid_t thread, unsigned long address, char *path) {
    size_t length = 0;
    path[0] = 0;
    /* Page by page: the string may end before memory that cannot be read. */
    while (length < PATH_MAX - 1) {
        size_t part = 4096 - (address + length) % 4096;
        if (part > PATH_MAX - 1 - length)
            part = PATH_MAX - 1 - length;
        struct iovec to = {path + length, part}, from = {(void *)(address + length), part};
        ssize_t got = process_vm_readv(thread, &to, 1, &from, 1, 0);
        if (got <= 0)
            break;
        if (memchr(path + length, 0, got))
            return;
        length += got;
    }
    path[length] = 0;
}

/* Whether the program's working folder is the folder, so that relative paths are below it. */
static int is_below(const char *path) {
    size_t length = strlen(folder);
    if (path[0] != '/')
        return path[0] != 0 && strncmp(path, "pipe:", 5) && strncmp(path, "socket:", 7) && strncmp(path, "anon_inode:", 11);
    return !strncmp(path, folder, length) && (path[length] == '/' || path[length] == 0);
}

/* The name of a call that writes, and its path; none for other calls. */
static const char *writing_call(pid_t thread, const struct user_regs_struct *regs, char *path) {
    switch (regs->orig_rax) {
#define OF_FD(call)                                                                                                  \
    case SYS_##call:                                                                                                 \
        path_of_fd(thread, (long)regs->rdi, path);                                                                   \
        return #call;
#define OF_PATH(call, argument)                                                                                      \
    case SYS_##call:                                                                                                 \
        path_at(thread, regs->argument, path);                                                                       \
        return #call;
        OF_FD(write)
        OF_FD(writev)
        OF_FD(pwrite64)
        OF_FD(pwritev)
        OF_FD(pwritev2)
        OF_FD(ftruncate)
        OF_FD(fallocate)
        OF_FD(fsync)
        OF_FD(fdatasync)
        OF_FD(copy_file_range)
        OF_FD(sendfile)
        OF_PATH(creat, rdi)
        OF_PATH(mkdir, rdi)
        OF_PATH(mkdirat, rsi)
        OF_PATH(rename, rsi)
        OF_PATH(renameat, r10)
        OF_PATH(renameat2, r10)
        OF_PATH(link, rsi)
        OF_PATH(linkat, r10)
        OF_PATH(symlink, rsi)
        OF_PATH(unlink, rdi)
        OF_PATH(unlinkat, rsi)
    case SYS_open:
        path_at(thread, regs->rdi, path);
        return regs->rsi & (O_WRONLY | O_RDWR | O_CREAT) ? "open" : NULL;
    case SYS_openat:
        path_at(thread, regs->rsi, path);
        return regs->rdx & (O_WRONLY | O_RDWR | O_CREAT) ? "openat" : NULL;
    case SYS_close: {
        /* Of a file that may have been written: others cannot fail. */
        char info[64], line[128];
        path_of_fd(thread, (long)regs->rdi, path);
        snprintf(info, sizeof info, "/proc/%d/fdinfo/%ld", thread, (long)regs->rdi);
        FILE *file = fopen(info, "r");
        unsigned flags = 0;
        while (file && fgets(line, sizeof line, file))
            if (sscanf(line, "flags: %o", &flags) == 1)
                break;
        if (file)
            fclose(file);
        return flags & (O_WRONLY | O_RDWR) ? "close" : NULL;
    }
    default:
        return NULL;
    }
}

static int needs_space(const char *call) {
    return strncmp(call, "unlink", 6) && strcmp(call, "fsync") && strcmp(call, "fdatasync") && strcmp(call, "close");
}

static int is_write(const char *call) {
    return strstr(call, "write") != NULL;
}

static void enter(pid_t thread, int slot, struct user_regs_struct *regs) {
    char path[PATH_MAX];
    const char *call = writing_call(thread, regs, path);
    if (!call || !is_below(path))
        return;
    count++;
    fprintf(report, "%s %s\n", call, path);
    if (!wanted || count < wanted)
        return;
    int is_short = !strcmp(fault, "short"), is_full = !strcmp(fault, "enospc");
    if (is_short && count == wanted && is_write(call) && regs->rdx > 1 && regs->orig_rax == SYS_write) {
        regs->rdx /= 2;
        ptrace(PTRACE_SETREGS, thread, 0, regs);
        return;
    }
    if (is_short || (is_full ? !needs_space(call) : count != wanted))
        return;
    threads[slot].error = is_full ? ENOSPC : !strcmp(fault, "eio") ? EIO : EINTR;
    /* A close that fails has closed the file. */
    if (strcmp(call, "close"))
        ptrace(PTRACE_POKEUSER, thread, offsetof(struct user, regs.orig_rax), -1L);
}

static void leave(pid_t thread, int slot) {
    if (threads[slot].error)
        ptrace(PTRACE_POKEUSER, thread, offsetof(struct user, regs.rax), -(long)threads[slot].error);
    threads[slot].error = 0;
}

int main(int argc, char **argv) {
    if (argc < 6)
        return 125;
    folder = argv[1], fault = argv[2], wanted = atol(argv[3]);
    report = fopen(argv[4], "w");
    pid_t program = fork();
    if (!report || program < 0)
        return 125;
    if (!program) {
        if (ptrace(PTRACE_TRACEME, 0, 0, 0)) {
            perror("inject: ptrace");
            _exit(126);
        }
        raise(SIGSTOP);
        execv(argv[5], argv + 5);
        perror(argv[5]);
        _exit(127);
    }
    int status;
    if (waitpid(program, &status, 0) != program || !WIFSTOPPED(status))
        return WIFEXITED(status) ? WEXITSTATUS(status) : 126;
    if (ptrace(PTRACE_SETOPTIONS, program, 0,
               PTRACE_O_TRACESYSGOOD | PTRACE_O_TRACECLONE | PTRACE_O_TRACEEXEC | PTRACE_O_EXITKILL))
        return 126;
    ptrace(PTRACE_SYSCALL, program, 0, 0);
    for (;;) {
        pid_t thread = waitpid(-1, &status, __WALL);
        if (thread < 0)
            return 125;
        if (!WIFSTOPPED(status)) {
            if (thread == program)
                break;
            threads[slot_of(thread)].thread = 0;
            continue;
        }
        int is_new = 1, signal = WSTOPSIG(status);
        for (int at = 0; at < MAX_THREADS; at++)
            is_new &= threads[at].thread != thread;
        int slot = slot_of(thread);
        if (signal == (SIGTRAP | 0x80)) {
            signal = 0;
            struct user_regs_struct regs;
            threads[slot].is_inside = !threads[slot].is_inside;
            if (!threads[slot].is_inside)
                leave(thread, slot);
            else if (!ptrace(PTRACE_GETREGS, thread, 0, &regs))
                enter(thread, slot, &regs);
        } else if (status >> 16 || (is_new && signal == SIGSTOP)) {
            /* An event of the tracer, or the first stop of a thread. */
            signal = 0;
        }
        ptrace(PTRACE_SYSCALL, thread, 0, signal);
    }
    fclose(report);
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}
