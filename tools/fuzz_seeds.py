#!/usr/bin/env python3
"""Seeds and dictionaries for fuzzing the file readers, made from what the repository holds.

    tools/fuzz_seeds.py step FOLDER DICTIONARY

FOLDER gets small inputs: for STEP each face of samples/*.step as a file of its own (one of each
combination of entity types), and the small files of the reader's tests. DICTIONARY gets every keyword
that the reader's sources name. Both are deterministic.
"""
import hashlib
import pathlib
import re
import sys

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
    seeds = [path.read_text() for path in sorted((ROOT / "src/import/step").rglob("*.step"))]
    seen = set()
    for path in sorted((ROOT / "samples").glob("*.step")):
        for types, text in step_faces(path.read_text()):
            if types not in seen and len(text) <= LARGEST:
                seen.add(types)
                seeds.append(text)
    return seeds


def dictionary(folder: str) -> list[str]:
    """Words in capitals that the sources in `folder` quote."""
    sources = [path.read_text() for path in sorted((ROOT / folder).rglob("*.rs"))]
    words = {word for text in sources for word in re.findall(r'"([A-Z][A-Z0-9_-]{2,})"', text)}
    return sorted(words | {"#1", "$", "*", "(())", ".T.", ".F.", "1.E-9", "''"})


FORMATS = {"step": (step, "src/import/step")}


def main() -> None:
    if len(sys.argv) != 4 or sys.argv[1] not in FORMATS:
        sys.exit(__doc__)
    seeds, sources = FORMATS[sys.argv[1]]
    folder = pathlib.Path(sys.argv[2])
    folder.mkdir(parents=True, exist_ok=True)
    texts = seeds()
    for text in texts:
        (folder / hashlib.sha1(text.encode()).hexdigest()).write_text(text)
    words = dictionary(sources)
    pathlib.Path(sys.argv[3]).write_text("".join(f'"{word}"\n' for word in words))
    print(f"{len(texts)} seeds, {len(words)} words")


if __name__ == "__main__":
    main()
