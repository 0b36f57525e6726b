#!/usr/bin/env python3
"""Compares zonal with what registries have, and writes docs/measure/peers.md.

    python3 measure/peers/peers.py

Installs sphericart, ducc0 and pyshtools from PyPI into a virtual environment, splat-transform from npm, and builds the
worker in Rust beside it twice, all below target/peers; what cannot be had is named on the page and left out. Then every
row of every worker is timed in turn, round after round, on one core and on the same inputs. A figure is the smallest of
its rounds; beside it stands how many times a copy of the same signals takes, timed in the same rounds. Errors are those
of all results against zonal in f64, which the packages that compute in f64 reach on their own."""

import importlib.metadata
import math
import os
import shutil
import subprocess
import sys
import time
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
WORK = ROOT / "target" / "peers"
PAGE = ROOT / "docs" / "measure" / "peers.md"
PYPI = {"sphericart": "2.0.4", "ducc0": "0.42.0", "pyshtools": "4.14.1"}
NPM = ("@playcanvas/splat-transform", "3.7.0")
FLAGS = {"baseline": "", "without SLP": "-C no-vectorize-slp", "native": "-C target-cpu=native"}
ROUNDS = 15
# Where signals pass by: so many of them are larger than a second cache, from order 4 or so on larger than a third.
PASSING = 102_400
PASSING_ROUNDS = 9
ORDERS = [3, 4, 5, 6, 8, 10]
COUNT = 1024
# Packages that turn one signal a call are asked so many times a round.
CALLS = 64
PASSES = 5


# What is installed, by whichever Python starts this.


def run(command, **options):
    print("$", " ".join(str(word) for word in command), file=sys.stderr)
    return subprocess.run(command, **options).returncode == 0


def install():
    """Installs and builds; returns nothing, since what is missing is seen by who looks for it."""
    environment = WORK / "venv"
    python = environment / "bin" / "python"
    if not python.exists():
        run([sys.executable, "-m", "venv", environment], check=True)
    for name, version in {"numpy": None, **PYPI}.items():
        wanted = f"{name}=={version}" if version else name
        run([python, "-m", "pip", "install", "--quiet", "--disable-pip-version-check", wanted])
    if shutil.which("npm"):
        run(["npm", "install", "--prefix", WORK / "npm", "--no-audit", "--no-fund", "--silent", "@".join(NPM)])
    for name, flags in FLAGS.items():
        environ = {**os.environ, "RUSTFLAGS": flags}
        manifest = ["--manifest-path", HERE / "Cargo.toml", "--target-dir", WORK / name]
        run(["cargo", "build", "--release", "--locked", *manifest], env=environ, check=True)
    return python


# Whoever answers with a time: a process, or a package of this Python.


class Worker:
    """A process that says its rows, then answers each number of one with nanoseconds a signal."""

    def __init__(self, name, command, results):
        self.name, self.results = name, results
        results.mkdir(parents=True, exist_ok=True)
        pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "text": True}
        self.process = subprocess.Popen([str(word) for word in command], **pipes)
        self.rows = []
        while line := self.line():
            function, order, *form = line.split()
            self.rows.append((function, int(order), " ".join(form)))

    def line(self):
        line = self.process.stdout.readline()
        if not line:
            sys.exit(f"the worker `{self.name}` ended early")
        return line.strip()

    def ask(self, question):
        self.process.stdin.write(f"{question}\n")
        self.process.stdin.flush()
        return self.line()

    def time(self, place):
        return float(self.ask(place))

    def written(self):
        self.ask("results")
        return [np.fromfile(self.results / f"result.{place}") for place in range(len(self.rows))]


class Packages:
    """The packages from PyPI that are there; a row is a function that returns its results as an array."""

    def __init__(self, inputs):
        self.missing, self.rows, self.work = [], [], []
        self.inputs = {name: np.fromfile(inputs / name) for name in ("quaternions", "directions", "signals")}
        for name, add in (("sphericart", self.sphericart), ("ducc0", self.ducc0), ("pyshtools", self.pyshtools)):
            try:
                add(__import__(name))
            except ImportError as error:
                self.missing.append(f"{name} {PYPI[name]} from PyPI ({error})")

    def add(self, function, order, form, count, work):
        self.rows.append((function, order, form))
        self.work.append((count, work))

    def time(self, place):
        count, work = self.work[place]
        best = math.inf
        for _ in range(PASSES):
            start = time.perf_counter_ns()
            work()
            best = min(best, (time.perf_counter_ns() - start) / count)
        return best

    def written(self):
        return [np.asarray(work()).reshape(-1) for _, work in self.work]

    def sphericart(self, package):
        """The basis of all directions in one call; the signs of odd m are turned afterwards."""
        directions = self.inputs["directions"].reshape(-1, 3)
        for order in ORDERS:
            signs = phases(order)
            harmonics = package.SphericalHarmonics(order - 1)
            for form, number in (("sphericart f32", np.float32), ("sphericart f64", np.float64)):
                given = np.ascontiguousarray(directions, dtype=number)
                self.add("evaluate_basis", order, form, COUNT, Sphericart(harmonics, given, signs))

    def ducc0(self, package):
        for order in ORDERS:
            for form, number in (("ducc0 f32", np.complex64), ("ducc0 f64", np.complex128)):
                signals = [complex_of(c, order).astype(number) for c in self.signals(order)]
                many = Ducc0(package, order, signals, self.angles)
                self.add("rotate", order, form, CALLS, many)
                self.add("apply", order, form, CALLS, Ducc0(package, order, [np.stack(signals)], self.angles[:1]))

    def pyshtools(self, package):
        for order in ORDERS:
            signals = [cilm_of(c, order) for c in self.signals(order)]
            self.add("rotate", order, "pyshtools f64", CALLS, Pyshtools(package, order, signals, self.angles))

    def signals(self, order):
        return self.inputs["signals"].reshape(-1, 100)[:CALLS, : order * order]

    @property
    def angles(self):
        return [zyz(q) for q in self.inputs["quaternions"].reshape(-1, 4)[:CALLS]]


class Sphericart:
    def __init__(self, harmonics, directions, signs):
        self.harmonics, self.directions, self.signs = harmonics, directions, signs

    def __call__(self):
        self.last = self.harmonics.compute(self.directions)
        return self

    def __array__(self, dtype=None, copy=None):
        return self.last.astype(np.float64) * self.signs


class Turned:
    """Rotations, one a call, whose results are read in zonal's order afterwards."""

    def __init__(self, package, order, signals, angles):
        self.package, self.order, self.signals, self.angles = package, order, signals, angles

    def __call__(self):
        self.last = [self.turn(c, *angles) for c, angles in zip(self.signals, self.angles)]
        return self


class Ducc0(Turned):
    def turn(self, c, a, b, g):
        return self.package.sht.rotate_alm(c, self.order - 1, g, b, a)

    def __array__(self, dtype=None, copy=None):
        rows = [row for c in self.last for row in (c if c.ndim == 2 else [c])]
        return np.concatenate([real_of(row.astype(np.complex128), self.order) for row in rows])


class Pyshtools(Turned):
    def __init__(self, package, order, signals, angles):
        super().__init__(package, order, signals, angles)
        self.table = package.rotate.djpi2(order - 1)

    def turn(self, c, a, b, g):
        return self.package.rotate.SHRotateRealCoef(c, np.array([-g, -b, -a]), self.table)

    def __array__(self, dtype=None, copy=None):
        return np.concatenate([of_cilm(c, self.order) for c in self.last])


# Conventions: zonal's coefficients are real, orthonormal, with the Condon-Shortley phase, index l(l+1)+m.


def phases(order):
    """The Condon-Shortley phase, which some leave out."""
    return np.array([(-1.0) ** m for l in range(order) for m in range(-l, l + 1)])


def zyz(q):
    """The angles a, b, g of the rotation by g about z, then b about y, then a about z."""
    x, y, z, w = q / np.linalg.norm(q)
    b = 2 * math.atan2(math.hypot(x, y), math.hypot(z, w))
    half_sum, half_difference = math.atan2(z, w), math.atan2(-x, y)
    return half_sum + half_difference, b, half_sum - half_difference


def places(order):
    """(l, m, index of ducc0's complex coefficient) for m from 0."""
    return [(l, m, m * (2 * order - 1 - m) // 2 + l) for l in range(order) for m in range(l + 1)]


def complex_of(c, order):
    out = np.zeros(order * (order + 1) // 2, complex)
    for l, m, place in places(order):
        centre = l * (l + 1)
        out[place] = c[centre] if m == 0 else (c[centre + m] - 1j * c[centre - m]) / math.sqrt(2)
    return out


def real_of(a, order):
    out = np.zeros(order * order)
    for l, m, place in places(order):
        centre = l * (l + 1)
        out[centre + m] = a[place].real * (math.sqrt(2) if m else 1)
        if m:
            out[centre - m] = -a[place].imag * math.sqrt(2)
    return out


def cilm_of(c, order):
    """As pyshtools has them, without the phase."""
    out = np.zeros((2, order, order))
    for l, m, _ in places(order):
        out[0, l, m] = (-1) ** m * c[l * (l + 1) + m]
        if m:
            out[1, l, m] = (-1) ** m * c[l * (l + 1) - m]
    return out


def of_cilm(x, order):
    out = np.zeros(order * order)
    for l, m, _ in places(order):
        out[l * (l + 1) + m] = (-1) ** m * x[0, l, m]
        if m:
            out[l * (l + 1) - m] = (-1) ** m * x[1, l, m]
    return out


# The measurement and its page.

FORMS = {
    "call": "a call",
    "into": "a call, in place",
    "loop": "a plain loop",
    "arrays": "a batch of arrays",
    "blocks": "a batch of blocks",
}
SECTIONS = [
    (
        "rotate",
        "A rotation a signal",
        "`rotate`, from a quaternion, the set-up included. Packages of Python turn one signal a call, whose own cost is in it.",
    ),
    ("apply", "One rotation for all signals", "`Rotation::apply`, without its set-up, but with that of ducc0, which turns 64 signals a call."),
    ("evaluate_basis", "The basis", "`evaluate_basis`: n² numbers a direction; sphericart takes all directions in a call."),
    ("evaluate", "The value in a direction", "`evaluate`: n² numbers are read, one is written."),
    ("tilt", "A tilt", "`tilt`, to a normal that leans by 17 degrees at most."),
    (
        "splats",
        "Splats",
        "One rotation for rows of 3 first coefficients and the rest of red, green and blue, copied, then turned in place. "
        "In copies of one channel's signals.",
    ),
]

# Written by hand: each needs a program of its own.
SPELLINGS = """## What keeps SLP from a single call

LLVM's SLP pass makes vectors of scalar code. It begins at numbers that are stored side by side, as a kernel's results are, and
for `rotate` without multiply-add instructions the moves cost more than the vectors save. Rust has no attribute against it. What
was tried, in copies, compiled for the baseline by rustc 1.95:

| | n = 3 | n = 4 | n = 5 | n = 6 |
|---|---|---|---|---|
| DirectXMath, another day | 85 | 63 | 59 | 56 |
| the kernel by value, its result written in place | 47 | 65 | 66 | 60 |
| the same, a `compiler_fence` after each number | 40 | 52 | 54 | 56 |
| a fence after every third number | 54 | 61 | 77 | 73 |
| fences between numbers of an array that is then returned | 47 | 53 | 55 | 58 |
| the kernel into a sink, no fence | 47 | 68 | 60 | 65 |
| into a sink, a fence after each number | 37 | 49 | 52 | 53 |
| **set-up and bands into a sink, a fence after each number: `rotate_into`** | 36 | 49 | 51 | 52 |
| the bits of every second number xor a zero that the compiler cannot know | 39 | 52 | 56 | 58 |
| of every fourth number | 39 | 56 | 61 | 63 |
| relaxed atomics on the stack, copied out | 50 | 66 | 66 | 60 |
| `black_box` of every fourth number | 39 | 61 | 70 | 79 |
| `black_box` of each number's address | 44 | 62 | 65 | 59 |

Operations on `__m128` need `unsafe`: that SSE is on in the build is not enough for rustc, the function has to say so too. A fence
keeps a loop around the call from being made one of vectors as well, so that `rotate` has none: it takes 12 ns in a loop of order 5
where it is inlined. By the same means, times of the form by value, baseline and native, in copies, n = 3, 4, 5, 6, 8, 10:
`tilt` 25, 33, 32, 31, 33, 35 becomes 25, 33, 28, 27, 30, 31 (native 21, 25, 24, 22, 24, 26 becomes 21, 25, 22, 22, 23, 25);
the basis 7.8, 8.6, 9.1, 8.6, 10.6, 10 becomes 7, 8.6, 7.2, 7.2, 7.7, 8.2 (native 7.4, 7.4, 6.8, 6.7, 6.9, 7.7 becomes 7.1, 8.1, 7,
7.1, 7.4, 7.9); `rotate` of three channels 124, 134, 113, 112, 218, 243 becomes 97, 106, 107, 107, 128, 230 (native 111, 98, 84, 82,
121, 218 becomes 90, 86, 76, 75, 83, 161). `Rotation::apply` gains at order 6 and loses at others, and has no such form.
"""


def name_of(worker, form):
    if form in FORMS:
        return f"zonal, {FORMS[form]}" + (f", {worker}" if worker else "")
    return f"{form}, {worker}" if worker else form


def short(value):
    """Three significant digits."""
    decimals = max(0, 2 - math.floor(math.log10(value))) if value > 0 else 0
    text = f"{value:.{decimals}f}"
    return text.rstrip("0").rstrip(".") if "." in text else text


def measure():
    inputs = WORK / "baseline" / "inputs"
    workers = []
    for name in FLAGS:
        folder = WORK / name / "inputs"
        folder.mkdir(parents=True, exist_ok=True)
        workers.append((name, Worker(name, [WORK / name / "release" / "zonal-peers", folder, COUNT], folder)))
    packages = Packages(inputs)
    workers.append(("", packages))
    missing = packages.missing
    entry = WORK / "npm" / "node_modules" / NPM[0] / "dist" / "index.mjs"
    if shutil.which("node") and entry.exists():
        folder = WORK / "npm" / "results"
        workers.append(("", Worker("node", ["node", HERE / "splats.mjs", entry, inputs, folder], folder)))
    else:
        missing.append(f"{' '.join(NPM)} from npm")

    best, errors, copies = {}, {}, {}
    for turn in range(ROUNDS):
        print(f"round {turn + 1} of {ROUNDS}", file=sys.stderr)
        for name, worker in workers:
            for place, (function, order, form) in enumerate(worker.rows):
                taken = worker.time(place)
                key = (function, name_of(name, form), order)
                best[key] = min(best.get(key, math.inf), taken)
                if function == "copy":
                    copies[order] = min(copies.get(order, math.inf), taken)
    for name, worker in workers:
        for (function, order, form), got in zip(worker.rows, worker.written()):
            truth = inputs / f"{function}.{order}"
            if truth.exists() and order in ORDERS + [2]:
                want = np.fromfile(truth)[: len(got)]
                if form == "sphrs":
                    got = got * np.tile(phases(order), COUNT)
                key = (function, name_of(name, form))
                errors[key] = max(errors.get(key, 0.0), float(np.abs(got - want).max()))
    return best, errors, copies, missing


def passing():
    """Times of plain loops over signals that no cache holds, by flags."""
    workers, best = [], {}
    for name in ("baseline", "native"):
        folder = WORK / name / "passing"
        folder.mkdir(parents=True, exist_ok=True)
        workers.append((name, Worker(name, [WORK / name / "release" / "zonal-peers", folder, PASSING], folder)))
    for turn in range(PASSING_ROUNDS):
        print(f"round {turn + 1} of {PASSING_ROUNDS}, signals passing by", file=sys.stderr)
        for name, worker in workers:
            for place, (function, order, form) in enumerate(worker.rows):
                if form == "loop" and order in ORDERS:
                    key = (function, name, order)
                    best[key] = min(best.get(key, math.inf), worker.time(place))
    return best


def page(best, errors, copies, missing, far):
    versions = [f"{name} {importlib.metadata.version(name)}" for name in PYPI if name not in " ".join(missing)]
    versions += [f"{NPM[0]} {NPM[1]}"] * (NPM[0] not in " ".join(missing)) + ["sphrs 0.2.2"]
    text = "<!-- Written by `python3 measure/peers/peers.py`; do not edit. -->\n\n# Zonal beside its peers\n\n"
    text += (
        "Nanoseconds a signal on one core, and in brackets how many times a copy of the same signals takes: the smallest "
        f"of {ROUNDS} rounds in which all rows take turns, over {COUNT} signals, which stay in a cache. The error is the "
        "largest of any coefficient at the orders of the table, for coefficients from −1 to 1, against zonal in f64 from "
        "the same inputs, of length one. *Baseline*: compiled for the architecture's baseline; *native*: with "
        "`-C target-cpu=native`, which fuses multiply-adds; *without SLP*: the baseline with `-C no-vectorize-slp`. *A call* returns its result by value, *in place* writes it "
        "where it belongs, by `rotate_into`, `tilt_into` or `evaluate_basis_into` where it is one of these, *a plain loop* has the kernel inlined; *a batch* works on all "
        "signals in one call of `zonal::batch`, by the widest vector unit whatever the flags. Absolute times do not carry over to another machine.\n\n"
        f"Compared with {', '.join(versions)}. No test reads these figures.\n"
    )
    if missing:
        text += f"\nNot to be had where this was written: {'; '.join(missing)}.\n"
    for function, title, what in SECTIONS:
        orders = [2, 3, 4] if function == "splats" else ORDERS
        names = list(dict.fromkeys(name for known, name, order in best if known == function and order in orders))
        text += f"\n## {title}\n\n{what}\n\n| |"
        text += "".join(f" n = {order} |" for order in orders) + " error |\n|---|" + "---|" * (len(orders) + 1) + "\n"
        text += "| copy |" + "".join(f" {short(copies[order])} |" for order in orders) + " |\n"
        if function == "evaluate_basis":
            fill = lambda order: min(x for (known, _, at), x in best.items() if (known, at) == ("fill", order))
            text += "| zeros written |" + "".join(f" {short(fill(order))} |" for order in orders) + " |\n"
        for name in names:
            cells = (best.get((function, name, order)) for order in orders)
            shown = [f"{short(x)} ({short(x / copies[order])})" if x else "" for x, order in zip(cells, orders)]
            error = errors.get((function, name))
            text += f"| {name} | {' | '.join(shown)} | {error:.1e} |\n" if error is not None else ""
    return text + "\n" + native(best, far) + "\n" + SPELLINGS


def native(best, far):
    """What a plain loop loses by the flag, in words."""
    text = "## What `-C target-cpu=native` does to plain loops\n\nTimes of the baseline's, for a plain loop and for a call "
    text += "in place; above one is slower.\n\n| |" + "".join(f" n = {order} |" for order in ORDERS) + "\n"
    text += "|---|" + "---|" * len(ORDERS) + "\n"
    for function, *_ in SECTIONS[:5]:
        for title, of in (
            (FORMS["into"], lambda flags, order: best[function, f"zonal, {FORMS['into']}, {flags}", order]),
            (FORMS["loop"], lambda flags, order: best[function, f"zonal, {FORMS['loop']}, {flags}", order]),
            (f"{FORMS['loop']}, {PASSING} signals", lambda flags, order: far[function, flags, order]),
        ):
            cells = [short(of("native", order) / of("baseline", order)) for order in ORDERS]
            text += f"| `{function}`, {title} | {' | '.join(cells)} |\n"
    return text + (
        "\nCalls gain, since multiply-adds are fused. A loop over an array of structs may lose: where vectors are wide the "
        "compiler works on as many signals at once and gathers and scatters their numbers one by one, which is dear where "
        "they are in no cache.\n"
    )


if __name__ == "__main__":
    if "--measure" not in sys.argv:
        python = install()
        # Memory of its own a round: pages that happen to share a set of the cache do so in one round and not in all.
        os.environ.update(OMP_NUM_THREADS="1", OPENBLAS_NUM_THREADS="1", MALLOC_MMAP_THRESHOLD_="65536")
        os.execv(python, [str(python), __file__, "--measure"])
    import numpy as np

    if hasattr(os, "sched_setaffinity"):
        os.sched_setaffinity(0, {max(os.sched_getaffinity(0))})
    PAGE.write_text(page(*measure(), passing()))
    print(PAGE)
