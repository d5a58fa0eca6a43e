"""A QEMU machine with Debian's kernel, a graphics card with two heads and a serial port to its workload."""

import json
import pathlib
import socket
import struct
import subprocess
import time

BOOT_LIMIT_S = 120
ANSWER_LIMIT_S = 20


def connect(path):
    """To a unix socket that QEMU is about to make."""
    end = time.monotonic() + ANSWER_LIMIT_S
    while True:
        connection = socket.socket(socket.AF_UNIX)
        connection.settimeout(ANSWER_LIMIT_S)
        try:
            connection.connect(str(path))
            return connection
        except OSError:
            connection.close()
            if time.monotonic() > end:
                raise
            time.sleep(0.05)


class Monitor:
    """QEMU's machine protocol (QMP)."""

    def __init__(self, path):
        self.stream = connect(path).makefile("rw")
        self.stream.readline()
        self.command("qmp_capabilities")

    def command(self, name, **arguments):
        self.stream.write(json.dumps({"execute": name, "arguments": arguments}) + "\n")
        self.stream.flush()
        while True:
            answer = json.loads(self.stream.readline())
            if "error" in answer:
                raise RuntimeError(f"{name}: {answer['error']['desc']}")
            if "return" in answer:
                return answer["return"]


class Picture:
    """A screenshot: size and RGB bytes."""

    def __init__(self, path):
        magic, width, height, depth, self.rgb = pathlib.Path(path).read_bytes().split(maxsplit=4)
        self.size = int(width), int(height)
        if (magic, depth) != (b"P6", b"255") or len(self.rgb) != 3 * self.size[0] * self.size[1]:
            raise ValueError(f"{path}: no picture")


class Head:
    """A display that can be plugged in and unplugged: QEMU takes a VNC client's window for the display's size."""

    def __init__(self, path):
        self.connection = connect(path)
        self._read(12)
        self.connection.sendall(b"RFB 003.008\n")
        self._read(self._read(1)[0])
        self.connection.sendall(b"\x01")  # no password
        self._read(4)
        self.connection.sendall(b"\x01")  # shared
        self._read(20)
        self._read(struct.unpack(">I", self._read(4))[0])
        extended_desktop_size = -308
        self.connection.sendall(struct.pack(">BxHi", 2, 1, extended_desktop_size))

    def _read(self, count):
        data = b""
        while len(data) < count:
            more = self.connection.recv(count - len(data))
            if not more:
                raise EOFError("QEMU's VNC server hung up")
            data += more
        return data

    def resize(self, width, height):
        screen = struct.pack(">IHHHHI", 0, 0, 0, width, height, 0)
        self.connection.sendall(struct.pack(">BxHHBx", 251, width, height, 1) + screen)

    def unplug(self):
        self.resize(0, 0)


class Machine:
    """Boots in `folder`, where its files stay; a context that leaves no process behind. It has one processor: with two,
    one emulated boot in about a hundred never reached its workload, and the others took longer."""

    def __init__(self, qemu, kernel, initramfs, folder):
        self.folder = pathlib.Path(folder)
        (self.folder / "initramfs").write_bytes(initramfs)
        (image,) = kernel.glob("boot/vmlinuz-*")
        place = lambda name: str(self.folder / name)
        self.process = subprocess.Popen(
            ["setpriv", "--pdeathsig", "KILL", qemu, "-nodefaults", "-no-user-config", "-no-reboot", "-machine", "q35",
             "-accel", "tcg,thread=multi", "-cpu", "Nehalem", "-smp", "1", "-m", "512",
             "-display", "none", "-vga", "none",
             "-kernel", str(image), "-initrd", place("initramfs"),
             "-append", "console=ttyS0 panic=-1 vt.global_cursor_default=0",
             "-chardev", f"file,id=console,path={place('console')}", "-serial", "chardev:console",
             "-qmp", f"unix:{place('monitor')},server=on,wait=off",
             "-chardev", f"socket,id=port,path={place('port')},server=on,wait=off",
             "-device", "virtio-serial-pci", "-device", "virtserialport,chardev=port",
             "-device", "virtio-gpu-pci,id=gpu0,xres=1024,yres=768,max_outputs=2",
             "-vnc", f"unix:{place('head1')},display=gpu0,head=1"],
            stdin=subprocess.DEVNULL)

    def __enter__(self):
        try:
            self.port = connect(self.folder / "port")
            self.answers = self.port.makefile("r")
            self.monitor = Monitor(self.folder / "monitor")
            self.projector = Head(self.folder / "head1")
            self.port.settimeout(BOOT_LIMIT_S)
            self.greeting = self.answers.readline().strip()
            self.port.settimeout(ANSWER_LIMIT_S)
        except BaseException:
            self.__exit__(None, None, None)
            raise
        return self

    def __exit__(self, kind, error, trace):
        self.process.kill()
        self.process.wait()

    def console(self):
        return (self.folder / "console").read_text(errors="replace")

    def ask(self, question):
        self.port.sendall(question.encode() + b"\n")
        answer = self.answers.readline()
        if not answer:
            raise EOFError(f"the workload is gone after '{question}'")
        return answer.strip()

    def screenshot(self, head):
        path = str(self.folder / f"head{head}.ppm")
        self.monitor.command("screendump", filename=path, device="gpu0", head=head)
        return Picture(path)
