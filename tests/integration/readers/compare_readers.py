"""Fails unless another reader finds in our models what ours finds: points, faces, colours and bounds.

compare_readers.py [--decimal-comma] SAMPLE_MODELS COMMAND...

COMMAND is run for each model with its file as last argument; `{decimal_point}` in it is filled in. Both programs
run in the C locale, or with --decimal-comma in a German one made for the occasion. A line on standard error is a
failure too."""

import os
import subprocess
import sys
import tempfile


def run(command, environment, folder):
    result = subprocess.run(command, env=environment, cwd=folder, capture_output=True, text=True)
    if result.returncode != 0 or result.stderr.strip():
        sys.exit(f"{' '.join(command)}: status {result.returncode}\n{result.stderr}")
    return [line.split() for line in result.stdout.splitlines()]


def locale_with_comma(folder):
    subprocess.run(["localedef", "-i", "de_DE", "-f", "UTF-8", os.path.join(folder, "de_DE.UTF-8")], check=True)
    return {"LOCPATH": folder, "LC_ALL": "de_DE.UTF-8"}


def differences(name, expected, found):
    for what, ours, theirs in zip(("points", "faces", "colors"), expected[1:4], found[1:4]):
        if theirs not in (ours, "-"):
            yield f"{name}: {theirs} {what}, not {ours}"
    ours, theirs = [float(text) for text in expected[4:]], [float(text) for text in found[4:]]
    # Single precision: of the numbers, and of the angle of the half turn.
    tolerance = 2e-7 * max(map(abs, ours))
    if len(theirs) != 6 or not all(abs(a - b) <= tolerance for a, b in zip(ours, theirs)):
        yield f"{name}: bounds {theirs}, not {ours}"


def main(arguments):
    comma = arguments[0] == "--decimal-comma"
    sample_models, *command = arguments[comma:]
    with tempfile.TemporaryDirectory() as folder:
        locale = locale_with_comma(folder) if comma else {"LC_ALL": "C"}
        environment = os.environ | locale
        command = [part.replace("{decimal_point}", "," if comma else ".") for part in command]
        samples = run([sample_models, folder], environment, folder)
        if not samples:
            sys.exit("no models")
        failures = []
        for expected in samples:
            (found,) = run([*command, expected[0]], environment, folder)
            print(" ".join(found))
            failures += differences(expected[0], expected, found)
    sys.exit("\n".join(failures) or 0)


main(sys.argv[1:])
