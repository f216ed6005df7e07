#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Layers and house rules of the sources.

Who may include whom; which library belongs to which folder; no printing or exiting in the
library; OpenMP clauses; SPDX line first; no -ffast-math; every external symbol is named pw_*.

usage: lint_layers.py [BUILD_DIR] [SOURCE_DIR]      exit status 0: nothing found
Without BUILD_DIR, or when it holds no libpilewright.a, the symbols are not looked at.
"""
import pathlib
import re
import subprocess
import sys

# layer: what its files may include
MAY_INCLUDE = {
    "engine/core": {"engine/core"},
    "kernels": {"engine/core", "kernels"},
    "partition": {"engine/core", "partition"},
    "engine": {"engine/core", "kernels", "partition", "engine"},
    "io": {"engine/core", "engine", "io"},
}
# system header: the only folders that may use it (programs and tests may use what they like)
HEADER_HOME = {
    "metis.h": {"partition"},
    "cholmod.h": {"engine"},
    "umfpack.h": {"engine"},
    "gmshc.h": {"io"},
    "hdf5.h": {"io"},
    "jansson.h": {"io"},
    "yaml.h": {"io"},
    "omp.h": {"engine", "engine/core"},
}
CALLS = r"(?<![\w.>])({})\s*\("
PRINTS = "printf|vprintf|puts|putchar|perror"
WRITES = "fprintf|vfprintf|fputs|fputc|putc|fwrite"
ENDS = "exit|_exit|_Exit|quick_exit|abort|assert"
HEAP = "malloc|calloc|realloc|free|aligned_alloc|posix_memalign"
FORBIDDEN = {
    "engine/core": f"{PRINTS}|{WRITES}|{ENDS}",
    "kernels": f"{PRINTS}|{WRITES}|{ENDS}|{HEAP}",
    "partition": f"{PRINTS}|{WRITES}|{ENDS}|{HEAP}",
    "engine": f"{PRINTS}|{WRITES}|{ENDS}|{HEAP}",
    "io": f"{PRINTS}|{ENDS}",
}
CODE = (".c", ".h", ".inc", ".def", ".cxx")
TAGGED = CODE + (".py", ".sh")
FOLDERS = ("engine", "kernels", "partition", "io", "tests", "bench", "cases", ".ci")


def layer(name):
    """Layer of a file or include path; None for programs, tests and what is outside the tree."""
    if re.match(r"engine/(main\w*\.[ch]|pilewright\.h)$", name):
        return None
    if name.startswith("engine/core/"):
        return "engine/core"
    top = name.split("/")[0]
    return top if top in MAY_INCLUDE else None


def blank(match):
    return re.sub(r"[^\n]", " ", match.group(0))


def strip_comments(text, strings=True):
    """Text with comments (and string contents) blanked; lines keep their numbers."""
    text = re.sub(r"/\*.*?\*/", blank, text, flags=re.S)
    pattern = r'//[^\n]*|"(?:\\.|[^"\\\n])*"' if strings else r"//[^\n]*"
    return re.sub(pattern, blank, text)


def line_of(text, offset):
    return text.count("\n", 0, offset) + 1


def check_includes(name, text):
    home = layer(name)
    for match in re.finditer(r'^\s*#\s*include\s+(["<])([^">]+)[">]', text, flags=re.M):
        place = f"{name}:{line_of(text, match.start(2))}"
        header = match.group(2)
        if match.group(1) == '"' and "/" not in header:
            yield f"{place}: include \"{header}\" from the root of the tree"
        if home is None:
            continue
        target = layer(header) if match.group(1) == '"' else None
        if target and target not in MAY_INCLUDE[home]:
            yield f"{place}: {home} must not include {header}"
        if home not in HEADER_HOME.get(header, {home}):
            yield f"{place}: {header} belongs to {', '.join(sorted(HEADER_HOME[header]))}"
        if header.startswith("vtk") and not name.endswith(".cxx"):
            yield f"{place}: VTK belongs to io/*.cxx"


def check_calls(name, text):
    home = layer(name)
    if home is None or name == "engine/core/mem.c":
        return
    for match in re.finditer(CALLS.format(FORBIDDEN[home]), text):
        yield f"{name}:{line_of(text, match.start())}: {match.group(1)}() in {home}"


def check_openmp(name, text):
    for match in re.finditer(r"#\s*pragma\s+omp\s+((?:[^\n]*\\\n)*[^\n]*)", text):
        clause, place = match.group(1), f"{name}:{line_of(text, match.start())}"
        if re.match(r"(atomic|critical)", clause):
            yield f"{place}: scatters are coloured, no atomic or critical sections"
        if "parallel" in clause.split() and "default(none)" not in clause:
            yield f"{place}: a parallel region needs default(none)"
        if re.match(r"(parallel\s+)?for\b", clause) and "schedule(" not in clause:
            yield f"{place}: a parallel loop names its schedule"


def check_text(path, name, raw):
    lines = raw.splitlines() or [""]
    first = lines[1:2] if lines[0].startswith("#!") else lines[:1]
    if not first or "SPDX-License-Identifier: GPL-3.0-or-later" not in first[0]:
        yield f"{name}:1: the SPDX line comes first"
    if path.suffix in CODE:
        for match in re.finditer(r"\b(TODO|FIXME|XXX|HACK)\b", raw):
            yield f"{name}:{line_of(raw, match.start())}: {match.group(1)} left in the source"
    if path.name != "lint_layers.py":
        code = "\n".join(line.split("#")[0] if path.suffix not in CODE else line for line in lines)
        for word in ("-ffast-math", "-Ofast", "fast-math"):
            if word in strip_comments(code, strings=False):
                yield f"{name}: {word} breaks bitwise results and hides NaN"
                break


def is_tagged(path):
    if path.name == "CMakeLists.txt" or path.suffix in TAGGED:
        return True
    return path.suffix == "" and path.read_bytes()[:2] == b"#!"


def check_sources(root):
    files = [root / "CMakeLists.txt"]
    for folder in FOLDERS:
        files += sorted(p for p in (root / folder).rglob("*") if p.is_file() and is_tagged(p))
    errors = []
    for path in files:
        name, raw = str(path.relative_to(root)), path.read_text()
        errors += check_text(path, name, raw)
        if path.suffix in CODE:
            errors += check_includes(name, strip_comments(raw, strings=False))
            errors += check_calls(name, strip_comments(raw))
            errors += check_openmp(name, strip_comments(raw))
    return len(files), errors


# What Fortran routines call back, by the names they use for it.
CALLED_BACK = r"(xit|stdb_abqerr|sinv|sprinc|sprind|rotsig|getoutdir|getjobname|getnumcpus)_$|_gfortran_"


def check_symbols(library):
    """External symbols of the C objects must be pw_*; C++ objects may add mangled names."""
    out = subprocess.run(["nm", "-g", "--defined-only", "-P", "-A", str(library)],
                         capture_output=True, text=True, check=True).stdout
    count, errors = 0, []
    for line in out.splitlines():
        member, symbol, kind = line.split()[:3]
        member = member.split("[")[-1].rstrip("]:")
        count += 1
        cxx = ".cxx" in member and (symbol.startswith("_Z") or kind in "VWu")
        sanitizer = re.match(r"(__|\.)?(asan|odr_asan|tsan|ubsan)", symbol.lstrip("_"))
        fortran = member.startswith("umat_") and re.match(CALLED_BACK, symbol)
        if not (symbol.startswith("pw_") or cxx or sanitizer or fortran):
            errors.append(f"{member}: external symbol {symbol} lacks the prefix pw_")
    return count, errors


def main():
    root = pathlib.Path(__file__).resolve().parent.parent
    if len(sys.argv) > 2:
        root = pathlib.Path(sys.argv[2]).resolve()
    nfiles, errors = check_sources(root)
    library = pathlib.Path(sys.argv[1]) / "libpilewright.a" if len(sys.argv) > 1 else None
    nsymbols = 0
    if library and library.exists():
        nsymbols, found = check_symbols(library)
        errors += found
    for line in errors:
        print(f"error: {line}")
    print(f"{nfiles} files, {nsymbols} external symbols, {len(errors)} violations")
    return 1 if errors or nfiles < 2 else 0


if __name__ == "__main__":
    sys.exit(main())
