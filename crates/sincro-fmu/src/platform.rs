//! Platforms of shared libraries: from the head of the file to the folder in an FMU.

use crate::description::FmiVersion;

/// Operating system and processor that a shared library is for, as the folders of an FMU name them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Platform {
    system: System,
    machine: Machine,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum System {
    Linux,
    Windows,
    Darwin,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Machine {
    X86,
    X86_64,
    Aarch64,
}

impl Platform {
    /// Platform of this program; none if FMI has no name for it.
    #[must_use]
    pub fn here() -> Option<Self> {
        let system = match std::env::consts::OS {
            "linux" => System::Linux,
            "windows" => System::Windows,
            "macos" => System::Darwin,
            _ => return None,
        };
        let machine = match std::env::consts::ARCH {
            "x86" => Machine::X86,
            "x86_64" => Machine::X86_64,
            "aarch64" => Machine::Aarch64,
            _ => return None,
        };
        Some(Self { system, machine })
    }

    /// Platform of a shared library, by the head of the file; none if it is no library of a platform that FMI names.
    #[must_use]
    pub(crate) fn of_library(bytes: &[u8]) -> Option<Self> {
        let half = |at: usize| Some(u16::from_le_bytes(bytes.get(at..at + 2)?.try_into().ok()?));
        let word = |at: usize| Some(u32::from_le_bytes(bytes.get(at..at + 4)?.try_into().ok()?));
        if bytes.starts_with(b"\x7fELF") {
            let machine = match half(18)? {
                3 => Machine::X86,
                62 => Machine::X86_64,
                183 => Machine::Aarch64,
                _ => return None,
            };
            return Some(Self { system: System::Linux, machine });
        }
        if bytes.starts_with(b"MZ") {
            let head = usize::try_from(word(0x3c)?).ok()?;
            let machine = match half(head.checked_add(4)?)? {
                0x14c => Machine::X86,
                0x8664 => Machine::X86_64,
                0xaa64 => Machine::Aarch64,
                _ => return None,
            };
            return Some(Self { system: System::Windows, machine });
        }
        if word(0)? == 0xfeed_facf {
            let machine = match word(4)? {
                0x0100_0007 => Machine::X86_64,
                0x0100_000c => Machine::Aarch64,
                _ => return None,
            };
            return Some(Self { system: System::Darwin, machine });
        }
        None
    }

    /// Name of the platform's folder below `binaries` in an FMU of a version: `linux64` in FMI 2.0, `x86_64-linux` in
    /// 3.0.
    #[must_use]
    pub fn folder(self, version: FmiVersion) -> &'static str {
        use {Machine as M, System as S};
        match (version, self.system, self.machine) {
            (FmiVersion::V2, S::Linux, M::X86) => "linux32",
            (FmiVersion::V2, S::Linux, M::X86_64) => "linux64",
            (FmiVersion::V2, S::Windows, M::X86) => "win32",
            (FmiVersion::V2, S::Windows, M::X86_64) => "win64",
            (FmiVersion::V2, S::Darwin, M::X86_64) => "darwin64",
            (_, S::Linux, M::X86) => "x86-linux",
            (_, S::Linux, M::X86_64) => "x86_64-linux",
            (_, S::Linux, M::Aarch64) => "aarch64-linux",
            (_, S::Windows, M::X86) => "x86-windows",
            (_, S::Windows, M::X86_64) => "x86_64-windows",
            (_, S::Windows, M::Aarch64) => "aarch64-windows",
            (_, S::Darwin, M::X86 | M::X86_64) => "x86_64-darwin",
            (_, S::Darwin, M::Aarch64) => "aarch64-darwin",
        }
    }

    /// Ending of the file name of a shared library, without the dot: `so`, `dll` or `dylib`.
    #[must_use]
    pub fn ending(self) -> &'static str {
        match self.system {
            System::Linux => "so",
            System::Windows => "dll",
            System::Darwin => "dylib",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn heads_of_libraries_tell_their_platform() {
        let mut elf = b"\x7fELF\x02\x01\x01".to_vec();
        elf.resize(20, 0);
        elf[18] = 62;
        let platform = Platform::of_library(&elf).unwrap();
        assert_eq!(platform.folder(FmiVersion::V2), "linux64");
        assert_eq!(platform.folder(FmiVersion::V3), "x86_64-linux");
        assert_eq!(Platform::of_library(b"MZ"), None);
        assert_eq!(Platform::of_library(b""), None);
        assert_eq!(Platform::of_library(b"#!/bin/sh\n"), None);
    }
}
