#!/usr/bin/env python3
"""Seeds and dictionaries for fuzzing the file readers, made from the repository's files.

    tools/fuzz_seeds.py FORMAT FOLDER DICTIONARY      FORMAT: step iges obj bv native scad brlcad rhino scene

FOLDER gets small inputs: the files and the quoted texts of the reader's tests; for STEP also each face of
samples/*.step as a file of its own (one of each combination of entity types); for the engine's own form
those converted by the program (SELVEDGE, else target/release/selvedge). Where SELVEDGE_MODELS names a folder,
its small files of that format are taken too, and the faces of its IGES files one by one. DICTIONARY gets every
keyword that the reader's sources name. All of it is deterministic.
"""
import ast
import hashlib
import os
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
# libFuzzer mutates small inputs best; the largest face kept has some 60 records
LARGEST = 6000

HEADER = "ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION((''),'2;1');\nFILE_NAME('','',(''),(''),'','','');\nFILE_SCHEMA(('AUTOMOTIVE_DESIGN'));\nENDSEC;\nDATA;\n"
FOOTER = "ENDSEC;\nEND-ISO-10303-21;\n"
# numbers above those of the samples would do as well; they are renumbered anyway
CONTEXT = """#1=(GEOMETRIC_REPRESENTATION_CONTEXT(3)GLOBAL_UNIT_ASSIGNED_CONTEXT((#2,#3))REPRESENTATION_CONTEXT('',''));
#2=(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.METRE.));
#3=(NAMED_UNIT(*)PLANE_ANGLE_UNIT()SI_UNIT($,.RADIAN.));
"""


def records(text: str) -> dict[int, str]:
    """Instances of the DATA section; strings of the samples hold neither `;` nor `#`."""
    data = text[text.index("DATA;") + 5 : text.rindex("ENDSEC;")]
    found = re.findall(r"#(\d+)\s*=\s*(.*?);\s*(?=#|$)", data, re.S)
    return {int(number): re.sub(r"\s+", " ", body) for number, body in found}


def step_faces(text: str):
    """Each face with all it refers to, as (types, file)."""
    all_records = records(text)
    for number, body in all_records.items():
        if not body.startswith("ADVANCED_FACE"):
            continue
        order, todo = [], [number]
        while todo:
            at = todo.pop()
            if at not in order:
                order.append(at)
                todo += [int(n) for n in re.findall(r"#(\d+)", all_records[at])]
        fresh = {old: new for new, old in enumerate(order, 7)}
        lines = [f"#{fresh[n]}=" + re.sub(r"#(\d+)", lambda m: f"#{fresh[int(m[1])]}", all_records[n]) + ";" for n in order]
        shell = f"#4=OPEN_SHELL('',(#7));\n#5=SHELL_BASED_SURFACE_MODEL('',(#4));\n#6=MANIFOLD_SURFACE_SHAPE_REPRESENTATION('',(#5),#1);\n"
        types = tuple(sorted(re.match(r"[A-Z0-9_]*", all_records[n])[0] for n in order))
        yield types, HEADER + CONTEXT + shell + "\n".join(lines) + "\n" + FOOTER


def step() -> list[str]:
    seeds = [path.read_text() for path in sorted((ROOT / "crates/io/src/import/step").rglob("*.step"))]
    seen = set()
    for path in sorted((ROOT / "samples").glob("*.step")):
        for types, text in step_faces(path.read_text()):
            if types not in seen and len(text) <= LARGEST:
                seen.add(types)
                seeds.append(text)
    return seeds


def quoted(folder: str) -> list[str]:
    """The texts of several words that the tests in `folder` quote; placeholders of `format!` stay as names."""
    found = []
    for path in sorted((ROOT / folder).rglob("*.rs")):
        if "tests" not in str(path.relative_to(ROOT)):
            continue
        for body in re.findall(r'"((?:[^"\\]|\\.)*)"', path.read_text(), re.S):
            body = re.sub(r"\\\n\s*", "", body)
            if len(body) > 12 and re.search(r"\s|;", body):
                body = re.sub(r"\\u\{(\w+)\}", lambda m: chr(int(m[1], 16)), body).replace("\n", "\\n")
                found.append(ast.literal_eval(f'"{body}"').replace("{{", "{").replace("}}", "}"))
    return found


def shared(*extensions: str) -> list[pathlib.Path]:
    """Files of the folder of models."""
    folder = os.environ.get("SELVEDGE_MODELS")
    files = sorted(pathlib.Path(folder).rglob("*")) if folder else []
    return [f for f in files if f.suffix.lower() in extensions]


def small(*extensions: str) -> list[bytes]:
    return [f.read_bytes() for f in shared(*extensions) if f.stat().st_size <= 5 * LARGEST]


IGES_GLOBAL = ",,4Hpart,5Ht.igs,6Hwriter,1H1,32,38,6,308,15,,1.,2,2HMM,1,0.01,,1.E-6,100.,,,11,0;"
# places of pointers in the parameters behind the type; None: all of them from the second on
IGES_POINTERS = {102: None, 118: (0, 1), 120: (0, 1), 122: (0,), 130: (0,), 140: (4,), 142: (1, 2, 3), 144: "face"}


def iges_file(entities: list[tuple[str, str]]) -> str:
    """A file of (parameters, form), numbered 1, 3, 5 and so on."""
    lines = [f"{'seed':<72}S{1:>7}", *(f"{IGES_GLOBAL[i:i + 72]:<72}G{i // 72 + 1:>7}" for i in range(0, len(IGES_GLOBAL), 72))]
    cards = []
    for number, (text, form) in zip(range(1, 2 * len(entities), 2), entities):
        kind, own = text.split(",")[0], [text[i : i + 64] for i in range(0, len(text), 64)]
        zeros = f"{0:>8}" * 5
        lines.append(f"{kind:>8}{len(cards) + 1:>8}{zeros}{0:>8}{'00000000':>8}D{number:>7}")
        lines.append(f"{kind:>8}{0:>8}{0:>8}{len(own):>8}{form:>8}{'':>24}{0:>8}D{number + 1:>7}")
        cards += [f"{card:<64}{number:>8}P" for card in own]
    lines += [f"{card}{i:>7}" for i, card in enumerate(cards, 1)]
    lines.append(f"{f'S{1:>7}G{2:>7}D{2 * len(entities):>7}P{len(cards):>7}':<72}T{1:>7}")
    return "\n".join(lines) + "\n"


def iges_faces(path: pathlib.Path):
    """Trimmed surfaces with what they point to, as (types, file)."""
    lines = [line.ljust(80) for line in path.read_text(errors="replace").splitlines()]
    text, forms = {}, {}
    directory = [line for line in lines if line[72] == "D"]
    for first, second in zip(directory[::2], directory[1::2]):
        forms[int(first[73:80])] = second[32:40].strip() or "0"
    for line in lines:
        if line[72] == "P":
            number = int(line[64:72])
            text[number] = text.get(number, "") + line[:64]
    values = {n: [v.strip() for v in t.split(";")[0].split(",")] for n, t in text.items() if "H" not in t}

    def places(of: list[str]) -> list[int]:
        rule = IGES_POINTERS.get(int(of[0]), ())
        if rule == "face":
            return [1, *range(4, len(of))]
        return [p + 1 for p in rule] if rule is not None else list(range(2, len(of)))

    for number in (n for n, v in values.items() if v[0] == "144"):
        order, todo = [], [number]
        while todo:
            at = todo.pop()
            if at in values and at not in order:
                order.append(at)
                todo += [int(values[at][p]) for p in places(values[at]) if p < len(values[at]) and values[at][p].isdigit()]
        fresh = {str(old): str(2 * new + 1) for new, old in enumerate(order)}
        entities = []
        for n in order:
            own = list(values[n])
            for p in places(own):
                if p < len(own):
                    own[p] = fresh.get(own[p], own[p])
            entities.append((",".join(own) + ";", forms[n]))
        yield tuple(sorted(values[n][0] for n in order)), iges_file(entities)


def iges() -> list[str]:
    seeds = [path.read_text() for path in sorted((ROOT / "crates/io/src/import/iges").rglob("*.igs"))]
    for path in sorted((ROOT / "crates/io/src/import/iges/tests").glob("*.rs")):
        for body in path.read_text().split("\nfn ")[1:]:
            entities = [(t, "0") for t in re.findall(r'"(\d{3},[^"{]*;)"', body)]
            if entities:
                seeds.append(iges_file(entities))
    seen = set()
    for path in shared(".igs", ".iges"):
        for types, text in iges_faces(path):
            if types not in seen and len(text) <= 3 * LARGEST:
                seen.add(types)
                seeds.append(text)
    return seeds


def obj() -> list:
    files = [path.read_text() for path in sorted((ROOT / "crates/io/src/import/obj").rglob("*.obj"))]
    return files + quoted("crates/io/src/import/obj") + small(".obj")


def bv() -> list:
    return quoted("crates/io/src/import/bv") + small(".bv")


def scad() -> list:
    return quoted("crates/io/src/import/scad") + small(".csg")


def brlcad() -> list:
    return quoted("crates/io/src/import/brlcad") + small(".asc")


def rhino() -> list:
    return [path.read_bytes() for path in sorted((ROOT / "crates/io/src/import/rhino").rglob("*.3dm"))] + small(".3dm")


def scene() -> list:
    """The gallery, and the texts of the reader's tests, which omit the first line of a scene."""
    version = "selvedge = 1\n"
    files = [path.read_text() for path in sorted((ROOT / "samples/gallery").glob("*.toml"))]
    texts = [text if text.startswith("selvedge") else version + text for text in quoted("crates/io/src/import/scene") if "=" in text]
    return files + texts + small(".toml")


def native() -> list[bytes]:
    """The contents of converted files after the header."""
    program = pathlib.Path(os.environ.get("SELVEDGE", ROOT / "target/release/selvedge"))
    if not program.exists():
        sys.exit(f"{program} is missing: cargo build --release -p selvedge-cli")
    header, seeds = 25, []
    with tempfile.TemporaryDirectory() as folder:
        for extension, texts in ((".step", step()), (".obj", obj()), (".csg", scad()), (".asc", brlcad())):
            for text in texts:
                source, target = pathlib.Path(folder, "seed" + extension), pathlib.Path(folder, "seed.selvedge")
                source.write_bytes(text if isinstance(text, bytes) else text.encode())
                target.unlink(missing_ok=True)
                subprocess.run([program, "convert", source, target], capture_output=True)
                if target.exists() and target.stat().st_size <= 2 * LARGEST:
                    seeds.append(target.read_bytes()[header:])
    return seeds


def step_words(sources: list[str]) -> set[str]:
    """Words in capitals."""
    words = {word for text in sources for word in re.findall(r'"([A-Z][A-Z0-9_-]{2,})"', text)}
    return words | {"#1", "$", "*", "(())", ".T.", ".F.", "1.E-9", "''"}


def plain_words(sources: list[str]) -> set[str]:
    words = {word for text in sources for word in re.findall(r'"(\$?[A-Za-z][A-Za-z0-9_]{0,23})"', text)}
    return words | {"nan", "1e-9", "1e300", "-1", "0", "4294967295", "{", "}", "[", "]"}


def native_words(sources: list[str]) -> set[str]:
    """Variants of enums, as MessagePack has them: a byte with the length, and the name."""
    names = {name for text in sources for name in re.findall(r"^    ([A-Z][A-Za-z0-9]{1,30})\b *[,({]", text, re.M)}
    return {f"\\x{0xA0 + len(name):02x}{name}" for name in names}


def iges_words(sources: list[str]) -> set[str]:
    kinds = {word for text in sources for word in re.findall(r"\b(1\d\d|308|314|402|406|408|5\d\d)\b", text)}
    return {f"{kind}," for kind in kinds} | {"1H,", "0.", "1.E9", ",,", ";"}


def rhino_words(_: list[str]) -> set[str]:
    """Type codes of openNURBS's chunks, as they stand in a file."""
    codes = (0x10000014, 0x20008070, 0x20008073, 0x02000071, 0x0200007C, 0x0002FFFA, 0x0002FFFB, 0x4000800A, 0x2000807F)
    return {"".join(f"\\x{byte:02x}" for byte in code.to_bytes(4, "little")) for code in codes}


def dictionary(folder: str, words) -> list[str]:
    """Words that the sources in `folder` quote, tests left out."""
    files = [path for path in sorted((ROOT / folder).rglob("*.rs")) if "tests" not in str(path.relative_to(ROOT))]
    return sorted(words([path.read_text() for path in files]))


FORMATS = {
    "step": (step, "crates/io/src/import/step", step_words),
    "iges": (iges, "crates/io/src/import/iges", iges_words),
    "obj": (obj, "crates/io/src/import/obj", plain_words),
    "bv": (bv, "crates/io/src/import/bv", plain_words),
    "native": (native, "crates/geometry/src/model", native_words),
    "scad": (scad, "crates/io/src/import/scad", plain_words),
    "brlcad": (brlcad, "crates/io/src/import/brlcad", plain_words),
    "scene": (scene, "crates/io/src/import/scene", plain_words),
    "rhino": (rhino, "crates/io/src/import/rhino", rhino_words),
}


def main() -> None:
    if len(sys.argv) != 4 or sys.argv[1] not in FORMATS:
        sys.exit(__doc__)
    seeds, sources, words = FORMATS[sys.argv[1]]
    folder = pathlib.Path(sys.argv[2])
    folder.mkdir(parents=True, exist_ok=True)
    texts = [text if isinstance(text, bytes) else text.encode() for text in seeds()]
    for text in texts:
        (folder / hashlib.sha1(text).hexdigest()).write_bytes(text)
    found = dictionary(sources, words)
    pathlib.Path(sys.argv[3]).write_text("".join(f'"{word}"\n' for word in found))
    print(f"{len(texts)} seeds, {len(found)} words")


if __name__ == "__main__":
    main()
