//! The restrictions of a worker process. A driver runs compilers on untrusted shaders; a fault in one of them
//! must not give a shader access to files, to the network or to other processes.
//!
//! Linux only, where the kernel supports it: Landlock limits access to files, seccomp limits system calls.
//! Both apply before the driver is loaded, and to all of its threads.

#[cfg(target_os = "linux")]
mod files;
#[cfg(target_os = "linux")]
mod system_calls;

use std::fmt;

use serde::{Deserialize, Serialize};

/// The environment variable that disables the sandbox with the value `off`, for drivers that it disturbs.
pub const SANDBOX_VARIABLE: &str = "TOYPROOF_SANDBOX";

/// How a worker process is restricted.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub enum Sandbox {
    /// Not at all: only Linux has the means.
    Unsupported,
    /// Not at all: [`SANDBOX_VARIABLE`] disables it.
    Disabled,
    /// As far as the kernel supports it.
    Enabled {
        /// The version of Landlock's interface, or why the kernel does not restrict access to files.
        landlock: Result<u32, String>,
        /// Why the kernel does not restrict system calls, if it does not.
        seccomp: Result<(), String>,
    },
}

impl fmt::Display for Sandbox {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unsupported => f.write_str("none: it needs Linux"),
            Self::Disabled => write!(f, "none: disabled by {SANDBOX_VARIABLE}=off"),
            Self::Enabled { landlock, seccomp } => {
                match landlock {
                    Ok(version) => write!(f, "Landlock ABI {version}")?,
                    Err(reason) => write!(f, "no Landlock ({reason})")?,
                }
                match seccomp {
                    Ok(()) => f.write_str(", seccomp"),
                    Err(reason) => write!(f, ", no seccomp ({reason})"),
                }
            }
        }
    }
}

/// Restricts this process, irrevocably. Without a driver, it has no access to files.
#[cfg(target_os = "linux")]
pub(super) fn enter(uses_driver: bool) -> Sandbox {
    if std::env::var_os(SANDBOX_VARIABLE).is_some_and(|value| value == "off") {
        return Sandbox::Disabled;
    }
    let allowed = if uses_driver {
        files::AllowedFiles::new(&|name| std::env::var_os(name))
    } else {
        files::AllowedFiles::default()
    };
    Sandbox::Enabled {
        landlock: files::restrict(&allowed),
        seccomp: system_calls::restrict(),
    }
}

/// Restricts nothing.
#[cfg(not(target_os = "linux"))]
pub(super) fn enter(_uses_driver: bool) -> Sandbox {
    Sandbox::Unsupported
}

/// Creates the folders of the driver's cache, which a worker can only fill.
#[cfg(target_os = "linux")]
pub(super) fn create_caches() {
    files::create_caches(&|name| std::env::var_os(name));
}

/// Does nothing: workers create their caches.
#[cfg(not(target_os = "linux"))]
pub(super) fn create_caches() {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_state_is_described() {
        let lacks = || Err("not in this kernel".to_owned());
        let enabled = |landlock, seccomp| Sandbox::Enabled { landlock, seccomp }.to_string();
        assert_eq!(enabled(Ok(4), Ok(())), "Landlock ABI 4, seccomp");
        assert_eq!(
            enabled(lacks(), Ok(())),
            "no Landlock (not in this kernel), seccomp"
        );
        assert_eq!(
            enabled(Ok(1), Err("not in this kernel".to_owned())),
            "Landlock ABI 1, no seccomp (not in this kernel)"
        );
        assert_eq!(
            Sandbox::Disabled.to_string(),
            "none: disabled by TOYPROOF_SANDBOX=off"
        );
        assert_eq!(Sandbox::Unsupported.to_string(), "none: it needs Linux");
    }
}
