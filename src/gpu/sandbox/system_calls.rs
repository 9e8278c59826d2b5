//! System calls that a driver has no use for fail with `EPERM`: those of networks, of other programs and
//! processes, and of the administration of the machine.
//!
//! They are a list of forbidden calls, not of allowed ones: the calls of a driver, a compiler and a C library
//! differ between their versions, and a call that is missing in a list of allowed ones would end a driver
//! that works. Access to files is Landlock's task.

use std::collections::BTreeMap;

use seccompiler::{
    BackendError, BpfProgram, SeccompAction, SeccompCmpArgLen, SeccompCmpOp, SeccompCondition, SeccompFilter,
    SeccompRule, TargetArch, sock_filter,
};

/// Forbidden system calls, whatever their arguments.
const FORBIDDEN: &[i64] = &[
    // Networks. A pair of connected sockets within the process is allowed.
    libc::SYS_socket,
    libc::SYS_connect,
    libc::SYS_bind,
    libc::SYS_listen,
    libc::SYS_accept,
    libc::SYS_accept4,
    // Other programs, and the memory of other processes.
    libc::SYS_execve,
    libc::SYS_execveat,
    libc::SYS_ptrace,
    libc::SYS_process_vm_readv,
    libc::SYS_process_vm_writev,
    libc::SYS_process_madvise,
    libc::SYS_pidfd_getfd,
    libc::SYS_kcmp,
    // Signals; to its own threads, a process sends them with `tgkill`.
    libc::SYS_kill,
    libc::SYS_tkill,
    libc::SYS_rt_sigqueueinfo,
    libc::SYS_rt_tgsigqueueinfo,
    libc::SYS_pidfd_send_signal,
    // File systems and namespaces.
    libc::SYS_mount,
    libc::SYS_umount2,
    libc::SYS_pivot_root,
    libc::SYS_chroot,
    libc::SYS_fsopen,
    libc::SYS_fsmount,
    libc::SYS_fsconfig,
    libc::SYS_fspick,
    libc::SYS_move_mount,
    libc::SYS_open_tree,
    libc::SYS_mount_setattr,
    libc::SYS_setns,
    libc::SYS_unshare,
    libc::SYS_name_to_handle_at,
    libc::SYS_open_by_handle_at,
    libc::SYS_quotactl,
    libc::SYS_fanotify_init,
    // Owners, modes, times and attributes of files, which Landlock does not protect.
    libc::SYS_fchmod,
    libc::SYS_fchmodat,
    FCHMODAT2,
    libc::SYS_fchown,
    libc::SYS_fchownat,
    libc::SYS_setxattr,
    libc::SYS_lsetxattr,
    libc::SYS_fsetxattr,
    libc::SYS_removexattr,
    libc::SYS_lremovexattr,
    libc::SYS_fremovexattr,
    libc::SYS_utimensat,
    // Interfaces of the kernel with a history of faults, and ways around these rules.
    libc::SYS_io_uring_setup,
    libc::SYS_io_uring_enter,
    libc::SYS_io_uring_register,
    libc::SYS_bpf,
    libc::SYS_perf_event_open,
    libc::SYS_userfaultfd,
    libc::SYS_personality,
    libc::SYS_add_key,
    libc::SYS_request_key,
    libc::SYS_keyctl,
    // The administration of the machine.
    libc::SYS_init_module,
    libc::SYS_finit_module,
    libc::SYS_delete_module,
    libc::SYS_kexec_load,
    libc::SYS_reboot,
    libc::SYS_swapon,
    libc::SYS_swapoff,
    libc::SYS_sethostname,
    libc::SYS_setdomainname,
    libc::SYS_settimeofday,
    libc::SYS_clock_settime,
    libc::SYS_clock_adjtime,
    libc::SYS_adjtimex,
    libc::SYS_acct,
    libc::SYS_vhangup,
    libc::SYS_syslog,
];

/// Older forms of the same that only this architecture has.
#[cfg(target_arch = "x86_64")]
const FORBIDDEN_HERE: &[i64] = &[
    libc::SYS_fork,
    libc::SYS_vfork,
    libc::SYS_chmod,
    libc::SYS_chown,
    libc::SYS_lchown,
    libc::SYS_utime,
    libc::SYS_utimes,
    libc::SYS_futimesat,
    libc::SYS_setrlimit,
    libc::SYS_kexec_file_load,
    libc::SYS_iopl,
    libc::SYS_ioperm,
];
#[cfg(not(target_arch = "x86_64"))]
const FORBIDDEN_HERE: &[i64] = &[];

/// The number of `fchmodat2` on all architectures, which not all versions of the libc crate name.
const FCHMODAT2: i64 = 452;

/// The smallest number of x32, the interface of x86-64 with short pointers, which no driver uses.
#[cfg(target_arch = "x86_64")]
const X32: u32 = 0x4000_0000;

/// The requests of `ioctl` that type into a terminal.
const TERMINAL_INPUT: [u64; 2] = [0x5412, 0x541C];

type Rules = BTreeMap<i64, Vec<SeccompRule>>;

/// Restricts all threads of this process.
///
/// # Errors
/// Why the kernel does not restrict system calls.
pub(super) fn restrict() -> Result<(), String> {
    let programs = programs(std::process::id()).map_err(|error| error.to_string())?;
    for program in programs {
        seccompiler::apply_filter_all_threads(&program).map_err(|error| error.to_string())?;
    }
    Ok(())
}

/// The filters for a process with that id. The kernel applies all of them.
fn programs(process: u32) -> Result<Vec<BpfProgram>, BackendError> {
    // A C library that is refused `clone3` calls `clone`, whose flags can be tested.
    let refused = Rules::from([(libc::SYS_clone3, Vec::new())]);
    Ok(vec![
        filter(forbidden(process)?, libc::EPERM)?,
        filter(refused, libc::ENOSYS)?,
        #[cfg(target_arch = "x86_64")]
        without_x32(),
    ])
}

/// Refuses x32, whose numbers are not in the rules.
#[cfg(target_arch = "x86_64")]
fn without_x32() -> BpfProgram {
    let instruction = |code, jt, jf, k| sock_filter { code, jt, jf, k };
    let load = (libc::BPF_LD | libc::BPF_W | libc::BPF_ABS) as u16;
    let jump_if_x32 = (libc::BPF_JMP | libc::BPF_JGE | libc::BPF_K) as u16;
    let result = (libc::BPF_RET | libc::BPF_K) as u16;
    vec![
        // The first word is the number.
        instruction(load, 0, 0, 0),
        instruction(jump_if_x32, 0, 1, X32),
        instruction(result, 0, 0, libc::SECCOMP_RET_ERRNO | libc::EPERM.unsigned_abs()),
        instruction(result, 0, 0, libc::SECCOMP_RET_ALLOW),
    ]
}

/// A program that makes these calls fail with an error and allows all others.
fn filter(rules: Rules, error: i32) -> Result<BpfProgram, BackendError> {
    let architecture = TargetArch::try_from(std::env::consts::ARCH)?;
    let fails = SeccompAction::Errno(error.unsigned_abs());
    SeccompFilter::new(rules, SeccompAction::Allow, fails, architecture)?.try_into()
}

fn forbidden(process: u32) -> Result<Rules, BackendError> {
    let always = FORBIDDEN
        .iter()
        .chain(FORBIDDEN_HERE)
        .map(|&call| (call, Vec::new()));
    let mut rules: Rules = always.collect();
    // Threads are allowed, processes are not: they would outlive this one.
    let thread = u64::from(libc::CLONE_THREAD.unsigned_abs());
    rules.insert(libc::SYS_clone, vec![when(0, SeccompCmpOp::MaskedEq(thread), 0)?]);
    rules.insert(libc::SYS_tgkill, vec![when(0, SeccompCmpOp::Ne, process.into())?]);
    // Limits are read by the same call.
    rules.insert(libc::SYS_prlimit64, vec![when(2, SeccompCmpOp::Ne, 0)?]);
    let types = TERMINAL_INPUT.map(|request| when(1, SeccompCmpOp::Eq, request));
    rules.insert(libc::SYS_ioctl, types.into_iter().collect::<Result<_, _>>()?);
    Ok(rules)
}

fn when(argument: u8, compares: SeccompCmpOp, value: u64) -> Result<SeccompRule, BackendError> {
    let length = match (argument, &compares) {
        // A pointer.
        (2, _) => SeccompCmpArgLen::Qword,
        _ => SeccompCmpArgLen::Dword,
    };
    SeccompRule::new(vec![SeccompCondition::new(argument, length, compares, value)?])
}

#[cfg(test)]
mod tests {
    use super::*;

    const PROCESS: u32 = 4321;

    /// The results of the filters for a call: the kernel's `struct seccomp_data` is the number, the
    /// architecture, the instruction pointer and six arguments.
    fn results(architecture: u32, call: i64, arguments: [u64; 6]) -> Vec<u32> {
        let mut data = Vec::new();
        data.extend((call as u32).to_le_bytes());
        data.extend(architecture.to_le_bytes());
        data.extend(0_u64.to_le_bytes());
        data.extend(arguments.iter().flat_map(|argument| argument.to_le_bytes()));
        let programs = programs(PROCESS).unwrap();
        programs.iter().map(|program| run(program, &data)).collect()
    }

    /// Runs a program of the instructions that these filters consist of (`linux/bpf_common.h`).
    fn run(program: &BpfProgram, data: &[u8]) -> u32 {
        let (mut accumulator, mut next) = (0_u32, 0);
        loop {
            let instruction = &program[next];
            let k = instruction.k;
            next += 1;
            let jump = |taken: bool| usize::from(if taken { instruction.jt } else { instruction.jf });
            match instruction.code {
                0x20 => {
                    let bytes = data[k as usize..][..4].try_into().unwrap();
                    accumulator = u32::from_le_bytes(bytes);
                }
                0x54 => accumulator &= k,
                0x05 => next += k as usize,
                0x15 => next += jump(accumulator == k),
                0x25 => next += jump(accumulator > k),
                0x35 => next += jump(accumulator >= k),
                0x06 => return k,
                code => panic!("instruction {code:#x} is not known"),
            }
        }
    }

    const ALLOW: u32 = libc::SECCOMP_RET_ALLOW;
    const FAILS: u32 = libc::SECCOMP_RET_ERRNO;
    #[cfg(target_arch = "x86_64")]
    const NATIVE: u32 = 0xC000_003E;
    #[cfg(target_arch = "aarch64")]
    const NATIVE: u32 = 0xC000_00B7;

    fn result(call: i64, arguments: [u64; 6]) -> u32 {
        // The kernel obeys the strictest.
        let results = results(NATIVE, call, arguments);
        results
            .into_iter()
            .find(|&result| result != ALLOW)
            .unwrap_or(ALLOW)
    }

    #[test]
    fn networks_programs_and_processes_are_refused() {
        let refused = FAILS | libc::EPERM as u32;
        for call in [
            libc::SYS_socket,
            libc::SYS_connect,
            libc::SYS_execve,
            libc::SYS_execveat,
            libc::SYS_ptrace,
            libc::SYS_mount,
            libc::SYS_kill,
            libc::SYS_io_uring_setup,
            libc::SYS_fchmodat,
        ] {
            assert_eq!(result(call, [0; 6]), refused, "{call}");
        }
        let signal = libc::CLONE_VM as u64 | libc::SIGCHLD as u64;
        assert_eq!(result(libc::SYS_clone, [signal, 0, 0, 0, 0, 0]), refused);
        assert_eq!(
            result(libc::SYS_tgkill, [u64::from(PROCESS) + 1, 1, 9, 0, 0, 0]),
            refused
        );
        assert_eq!(result(libc::SYS_prlimit64, [0, 9, 1 << 40, 0, 0, 0]), refused);
        assert_eq!(result(libc::SYS_ioctl, [0, 0x5412, 0, 0, 0, 0]), refused);
        assert_eq!(result(libc::SYS_clone3, [0; 6]), FAILS | libc::ENOSYS as u32);
    }

    #[test]
    fn what_drivers_do_is_allowed() {
        for call in [
            libc::SYS_openat,
            libc::SYS_mmap,
            libc::SYS_mprotect,
            libc::SYS_memfd_create,
            libc::SYS_futex,
            libc::SYS_sched_setaffinity,
            libc::SYS_socketpair,
            libc::SYS_unlinkat,
            libc::SYS_getrandom,
        ] {
            assert_eq!(result(call, [1; 6]), ALLOW, "{call}");
        }
        let thread = (libc::CLONE_VM | libc::CLONE_THREAD) as u64;
        assert_eq!(result(libc::SYS_clone, [thread, 0, 0, 0, 0, 0]), ALLOW);
        assert_eq!(result(libc::SYS_tgkill, [PROCESS.into(), 1, 6, 0, 0, 0]), ALLOW);
        assert_eq!(result(libc::SYS_prlimit64, [0, 9, 0, 1 << 40, 0, 0]), ALLOW);
        // DRM_IOCTL_VERSION
        assert_eq!(result(libc::SYS_ioctl, [0, 0xC040_6400, 0, 0, 0, 0]), ALLOW);
    }

    #[test]
    fn other_interfaces_of_the_processor_are_no_way_around() {
        let i386 = 0x4000_0003;
        assert_eq!(results(i386, 11, [0; 6])[0], libc::SECCOMP_RET_KILL_PROCESS);
        #[cfg(target_arch = "x86_64")]
        for call in [libc::SYS_socket, 520, 521] {
            assert_eq!(
                result(call | i64::from(X32), [0; 6]),
                FAILS | libc::EPERM as u32,
                "{call}"
            );
        }
    }
}
