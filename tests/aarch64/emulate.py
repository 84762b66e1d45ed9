"""Runs a static Linux program for AArch64 on any processor: `emulate.py PROGRAM [ARGUMENT...]`.

Unicorn, which is the translator of QEMU, carries out the instructions, and Qiling the system calls. The
program may have one thread; the exit status is its own.
"""

import errno
import functools
import os
import sys

from qiling import Qiling
from qiling.arch.arm64 import QlArchARM64
from qiling.const import QL_VERBOSE
from unicorn import UC_ARCH_ARM64, UC_MODE_ARM, Uc
from unicorn.arm64_const import UC_CPU_ARM64_MAX


def processor(_) -> Uc:
    """One with atomic instructions: Qiling tells programs that there are some, and chooses one without."""
    emulator = Uc(UC_ARCH_ARM64, UC_MODE_ARM)
    emulator.ctl_set_cpu_model(UC_CPU_ARM64_MAX)
    return emulator


QlArchARM64.uc = functools.cached_property(processor)
QlArchARM64.uc.__set_name__(QlArchARM64, "uc")


def main() -> int:
    emulated = Qiling(
        sys.argv[1:],
        rootfs="/",
        env=dict(os.environ),
        profile={"MISC": {"current_path": os.getcwd()}},
        verbose=QL_VERBOSE.DISABLED,
    )
    # Qiling has no mremap and answers 0, which the C library takes for an address; refused, it copies instead.
    emulated.os.set_syscall("mremap", lambda *_: -errno.ENOSYS)
    emulated.run()
    return emulated.os.exit_code


if __name__ == "__main__":
    sys.exit(main())
