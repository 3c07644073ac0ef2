"""Runs every shipped scene with two programs and compares all numbers: same_results.py OLD NEW [NAME ...].

For changes that must not change anything: OLD and NEW are `gearmesh` before and after. Models are reduced by OLD on coarse
meshes and read by both; runs in time have a twentieth of their time. Names of scenes choose some of them. A line a scene:
`same` where all numbers are equal to the last bit, else what differs and by how much of its largest value. Ends with 1 where
something differs. Times, the machine and the program's version are not compared.
"""

import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import h5py
import numpy as np

SHARE_OF_TIME = 20.0
MOST_S = 100.0
OF_THE_RUN = re.compile(r"second|created|clock|host|program|version|thread|wall|cost|memory|_s$")


def run(program: str, *words, folder: Path, most_s: float = MOST_S) -> tuple[int | None, str]:
    """Exit code and what is printed; no code where it takes too long."""
    try:
        done = subprocess.run([program, *map(str, words)], cwd=folder, capture_output=True, text=True, timeout=most_s)
    except subprocess.TimeoutExpired:
        return None, ""
    return done.returncode, done.stdout + done.stderr


def source_of(path: Path, scene: str, files: Path) -> Path | None:
    """The gear file of a model: the one that the head of the scene names, or one that is called like it."""
    named = re.search(rf"^#.*\breduce (?:\S*/)?(\S+\.toml) -o (?:\S*/)?{re.escape(path.name)}$", scene, re.M)
    if named and (files / named[1]).exists():
        return files / named[1]
    return next(iter(sorted(files.glob(f"{path.stem}.toml")) or sorted(files.glob(f"{path.stem}_*.toml"))), None)


def model(program: str, path: Path, source: Path | None, made: dict[Path, Path | None]) -> bool:
    """Whether the model of a gear file is there, reduced on a coarse mesh where it was not; `made`: the files of those there."""
    path = path.resolve()
    if source is None or made.get(path) == source:
        return source is not None
    text = source.read_text()
    if "[mesh]" not in text and "[bevel_gear" not in text:
        module, face = (float(re.search(rf"^{key}\s*=\s*([\d.]+)", text, re.M)[1]) for key in ("module_mm", "face_width_mm"))
        lengths = dict(flank=0.6 * module, fillet=0.2 * module, body=2 * module, axial=face / 4)
        source.write_text(text + "\n[mesh]\n" + "".join(f"{name}_mm = {mm:g}\n" for name, mm in lengths.items()))
    path.parent.mkdir(parents=True, exist_ok=True)
    done = run(program, "reduce", source.name, "-o", path, folder=source.parent, most_s=600)[0] == 0
    made[path] = source if done else None
    return done


def numbers(path: Path) -> dict[str, np.ndarray]:
    found = {}
    with h5py.File(path) as file:
        keep = lambda name, item: found.update({name: item[()]}) if isinstance(item, h5py.Dataset) and item.dtype.kind in "fiu" else None
        file.visititems(keep)
    return {name: np.asarray(values) for name, values in found.items() if not OF_THE_RUN.search(name)}


def differences(old: Path, new: Path) -> list[str]:
    a, b = numbers(old), numbers(new)
    found = [f"only in one: {name}" for name in sorted(a.keys() ^ b.keys())]
    for name in sorted(a.keys() & b.keys()):
        if a[name].shape != b[name].shape:
            found.append(f"{name}: shape {a[name].shape}, {b[name].shape}")
        elif not np.array_equal(a[name], b[name], equal_nan=a[name].dtype.kind == "f"):
            largest = np.nanmax(np.abs(a[name])) or 1.0
            found.append(f"{name}: {np.nanmax(np.abs(a[name].astype(float) - b[name])) / largest:.1e}")
    return found


def compared(scene: Path, programs: list[str], folder: Path, made: dict[Path, Path | None]) -> str:
    """What is printed of a scene; `made`: the gear files of the models that are there."""
    shorter = lambda m: f"{m[1]} = {float(m[2]) / SHARE_OF_TIME:.12g}"
    text = re.sub(r"^(end_s|statistics_from_s) = ([\d.e+-]+)", shorter, scene.read_text(), flags=re.M)
    scene.write_text(text)
    named = re.findall(r'"([^"]+\.h5)"', re.sub(r"^#.*$", "", text, flags=re.M))
    paths = [scene.parent / name for name in sorted(set(named))]
    if not all(model(programs[0], path, source_of(path, text, scene.parent), made) for path in paths):
        return "left out: its models cannot be reduced"
    results = [folder / f"{scene.stem}_{k}.h5" for k in range(2)]
    ends = [run(program, "run", scene.name, "-o", result, folder=scene.parent) for program, result in zip(programs, results)]
    codes = [code for code, _ in ends]
    if None in codes:
        return f"left out: takes more than {MOST_S:.0f} s"
    if codes[0] != codes[1]:
        return f"DIFFERS: ends with {codes[0]} and {codes[1]}"
    if not all(result.exists() for result in results):
        return "same, without a result" if ends[0] == ends[1] else "DIFFERS: " + ends[1][1][-200:]
    found = differences(*results)
    for result in results:
        result.unlink()
    return "DIFFERS: " + "; ".join(found[:6]) if found else "same"


def main(old: str, new: str, *names: str) -> int:
    programs = [str(Path(program).absolute()) for program in (old, new)]
    differ, made = 0, {}
    with tempfile.TemporaryDirectory() as temporary:
        files = Path(temporary) / "fe_models"
        shutil.copytree("fe_models", files)
        for scene in sorted(files.glob("*.toml")):
            text = scene.read_text()
            is_scene = re.search(r"^(\[run\]|run\s*=|\[tca\]|\[load\])", text, re.M) and not re.search(r"^scene\s*=", text, re.M)
            if is_scene and (not names or scene.stem in names):
                line = compared(scene, programs, Path(temporary), made)
                differ += line.startswith("DIFFERS")
                print(f"{scene.stem}: {line}", flush=True)
    return int(differ > 0)


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
