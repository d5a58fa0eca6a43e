"""Writes a Linux initramfs: busybox, a program with the shared libraries it needs, and kernel modules."""

import pathlib
import re
import subprocess

HERE = pathlib.Path(__file__).parent


class Archive:
    """The cpio format that the kernel unpacks (Documentation/driver-api/early-userspace/buffer-format.rst)."""

    def __init__(self):
        self.parts, self.size, self.names = [], 0, set()

    def _append(self, data):
        self.parts.append(data + bytes(-len(data) % 4))
        self.size += len(self.parts[-1])

    def _entry(self, name, mode, data=b""):
        numbers = [len(self.parts), mode, 0, 0, 1, 0, len(data), 0, 0, 0, 0, len(name) + 1, 0]
        header = b"070701" + b"".join(b"%08X" % number for number in numbers)
        self._append(header + name.encode() + b"\0")
        self._append(data)

    def folder(self, name):
        if name in ("", ".") or name in self.names:
            return
        self.folder(str(pathlib.PurePath(name).parent))
        self.names.add(name)
        self._entry(name, 0o040755)

    def file(self, name, data):
        self.folder(str(pathlib.PurePath(name).parent))
        self._entry(name, 0o100755, data)

    def bytes(self):
        self._entry("TRAILER!!!", 0)
        return b"".join(self.parts)


def modules_in_order(kernel, wanted):
    """The files of the modules and of those they depend on, each after what it needs. What is no file is built in."""
    files = {path.stem.replace("-", "_"): path for path in kernel.glob("lib/modules/*/kernel/**/*.ko")}
    order = []

    def add(name):
        path = files.get(name.replace("-", "_"))
        if path is None or path in order:
            return
        needs = re.search(rb"\0depends=([^\0]*)\0", path.read_bytes())
        for other in needs[1].decode().split(",") if needs else ():
            add(other)
        order.append(path)

    for name in wanted:
        add(name)
    return order


def shared_libraries(program):
    listing = subprocess.run(["ldd", program], check=True, capture_output=True, text=True).stdout
    return re.findall(r"(/\S+) \(0x", listing)


def build(program, kernel, modules):
    archive = Archive()
    for name in ("dev", "proc", "sys"):
        archive.folder(name)
    archive.file("init", (HERE / "init").read_bytes())
    archive.file("bin/busybox", pathlib.Path("/bin/busybox").read_bytes())
    archive.file("workload", pathlib.Path(program).read_bytes())
    for library in shared_libraries(program):
        archive.file(library.lstrip("/"), pathlib.Path(library).read_bytes())
    order = modules_in_order(kernel, modules)
    for path in order:
        archive.file(f"modules/{path.name}", path.read_bytes())
    archive.file("modules/order", "".join(f"{path.name}\n" for path in order).encode())
    return archive.bytes()
