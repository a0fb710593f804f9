"""Exports shipped scenes as C and runs their self-tests with several compilers, levels and processors.

Usage: exported_c.py SINCRO SCENES WORK

Needs the Debian packages clang, gcc-aarch64-linux-gnu, libc6-dev-arm64-cross, qemu-user, gcc-arm-none-eabi,
qemu-system-arm. Exit status 0 if at least twenty scenes export their whole experiment and every self-test finds its hash.
"""

import subprocess
import sys
from pathlib import Path

LEVELS = ["-O0", "-O1", "-O2", "-O3"]
MIN_WHOLE = 20

# A Cortex-M3 of qemu's lm3s6965evb: vectors, stack, and semihosting to report the result.
STARTUP = """
#include <stdint.h>
extern int NAME_self_test(void);
extern uint32_t stack_top, data_start, data_end, data_load, bss_start, bss_end;
static void leave(int is_good) {
    register int operation __asm__("r0") = 0x18; /* exit */
    register int reason __asm__("r1") = is_good ? 0x20026 : 0x20023;
    __asm__ volatile("bkpt 0xab" : : "r"(operation), "r"(reason));
    for (;;) {}
}
void reset(void) {
    uint32_t *from = &data_load, *to;
    for (to = &data_start; to < &data_end;) *to++ = *from++;
    for (to = &bss_start; to < &bss_end;) *to++ = 0;
    leave(NAME_self_test());
}
static void fault(void) { leave(0); }
__attribute__((section(".vectors"), used)) static void (*const vectors[16])(void) = {
    (void (*)(void))&stack_top, reset, fault, fault, fault, fault, fault,
};
"""

LAYOUT = """
MEMORY { flash (rx) : ORIGIN = 0, LENGTH = 256K  ram (rwx) : ORIGIN = 0x20000000, LENGTH = 64K }
SECTIONS {
  .text : { KEEP(*(.vectors)) *(.text*) *(.rodata*) } > flash
  .ARM.exidx : { *(.ARM.exidx*) } > flash
  .data : { data_start = .; *(.data*) . = ALIGN(4); data_end = .; } > ram AT > flash
  data_load = LOADADDR(.data);
  .bss : { bss_start = .; *(.bss*) *(COMMON) . = ALIGN(4); bss_end = .; } > ram
  stack_top = ORIGIN(ram) + LENGTH(ram);
}
"""


def run(command, folder):
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True)
    return done.returncode == 0, (done.stdout + done.stderr).strip()


def self_tests(folder, name):
    """Results of all compilers and levels: description, success, output."""
    sources = [f"{name}.c", f"{name}_test.c"]
    native = [("gcc", []), ("clang", [])]
    for compiler, wrapper in native + [("aarch64-linux-gnu-gcc", ["qemu-aarch64", "-L", "/usr/aarch64-linux-gnu"])]:
        for level in LEVELS:
            made, said = run([compiler, "-std=c99", "-pedantic", "-Wall", "-Wextra", "-Werror", level, *sources, "-o", "t"], folder)
            if made:
                made, said = run([*wrapper, "./t"], folder)
            yield f"{compiler} {level}", made, said
    # C++, and symbols: no library is called
    made, said = run(["g++", "-x", "c++", "-O2", "-ffp-contract=off", *sources, "-o", "t"], folder)
    yield "g++ -O2", *(run(["./t"], folder) if made else (made, said))
    run(["gcc", "-std=c99", "-O2", "-ffreestanding", "-c", f"{name}.c", "-o", "t.o"], folder)
    _, said = run(["nm", "-u", "t.o"], folder)
    unknown = [line for line in said.splitlines() if "_GLOBAL_OFFSET_TABLE_" not in line]
    yield "no symbols of libraries", not unknown, " ".join(unknown)


def cortex_m(folder, name):
    """The self-test on a Cortex-M3 without a C library."""
    (folder / "startup.c").write_text(STARTUP.replace("NAME", name))
    (folder / "layout.ld").write_text(LAYOUT)
    flags = ["-mcpu=cortex-m3", "-mthumb", "-std=gnu99", "-O1", "-ffreestanding", "-nostdlib", "-DSINCRO_NO_MAIN"]
    files = [f"{name}.c", f"{name}_test.c", "startup.c"]
    made, said = run(["arm-none-eabi-gcc", *flags, *files, "-T", "layout.ld", "-lgcc", "-o", "m.elf"], folder)
    if not made:
        return made, said
    machine = ["qemu-system-arm", "-M", "lm3s6965evb", "-nographic", "-monitor", "none", "-serial", "none"]
    return run([*machine, "-semihosting-config", "enable=on,target=native", "-kernel", "m.elf"], folder)


def main():
    sincro, scenes, work = (Path(argument).resolve() for argument in sys.argv[1:])
    whole, failures, total = [], 0, 0
    for experiment in sorted(scenes.glob("**/experiment.toml")):
        scene = experiment.parent
        name = "".join(c if c.isalnum() else "_" for c in scene.name)
        folder = work / name
        made, said = run([sincro, "export", "c", scene, "-o", folder, "--name", name, "--set", "integrator=rk4"], None)
        if not made or "self-test over" not in said:
            reasons = [line for line in said.splitlines() if "closed loop" in line] or said.splitlines()[:1]
            print(f"-- {scene.name}: {' '.join(reasons[0].split()) if reasons else ''}")
            continue
        whole.append(scene.name)
        results = list(self_tests(folder, name))
        if scene.name in ("two-dof-position", "spring-dynamic"):
            results.append(("cortex-m3, qemu", *cortex_m(folder, name)))
        bad = [result for result in results if not result[1]]
        total, failures = total + len(results), failures + len(bad)
        print(f"ok {scene.name}: {len(results)} self-tests" if not bad else f"!! {scene.name}")
        for what, _, said in bad:
            print(f"     {what}: {said[:300]}")
    print(f"{len(whole)} scenes whole, {total} self-tests, {failures} failed")
    return 0 if failures == 0 and len(whole) >= MIN_WHOLE else 1


if __name__ == "__main__":
    sys.exit(main())
