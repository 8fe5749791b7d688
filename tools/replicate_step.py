#!/usr/bin/env python3
"""Makes a large STEP file out of a real one: its bodies n times, side by side.

    tools/replicate_step.py IN.step OUT.step (COPIES | SIZE in MB, as in 100MB)

The DATA section is repeated with new instance numbers. Every copy is a product of its own, so a reader
sees n times the bodies and faces. All copies stand at the same place.
"""
import re
import sys


def split(text: str) -> tuple[str, str, str]:
    """The text before, in and after the DATA section."""
    start = re.search(r"\bDATA\s*;", text).end()
    end = text.rindex("ENDSEC")
    return text[:start], text[start:end], text[end:]


def main() -> None:
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    with open(sys.argv[1], encoding="latin-1", newline="") as source:
        head, data, tail = split(source.read())
    # references and text in turns: a `#` inside quotes is no reference
    pieces = re.split(r"((?:'(?:[^']|'')*')|#\d+)", data)
    numbers = [int(p[1:]) for p in pieces if p.startswith("#")]
    stride = max(numbers) + 1
    wanted = sys.argv[3]
    copies = round(float(wanted[:-2]) * 1e6 / len(data)) if wanted.endswith("MB") else int(wanted)
    with open(sys.argv[2], "w", encoding="latin-1", newline="") as target:
        target.write(head)
        for copy in range(max(copies, 1)):
            shift = copy * stride
            target.write("".join(f"#{int(p[1:]) + shift}" if p.startswith("#") else p for p in pieces))
        target.write(tail)
    print(f"{copies} copies of {len(data) / 1e6:.2f} MB")


if __name__ == "__main__":
    main()
