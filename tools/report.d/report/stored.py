"""benchmarks.json read back: the sections of earlier runs, as `rows.Report.as_json` wrote them.

    format  difference
    2       each section has its name and the run that measured it
    1       one run for all sections; it is given to each, and its title names a section

Each value is tested against its type in `rows`: what the output cannot hold is found before hours of measurement.
"""

import dataclasses
import json
import types
import typing

from .rows import SCHEMA, Contest, Missing, Promise, Run, Section

# what is computed anew from the figures
COMPUTED = {Contest: {"verdict", "lost", "reason", "ratio"}, Promise: {"broken"}}
READ = (1, SCHEMA)


class Unreadable(Exception):
    """The reason why a file gives no sections, as a sentence without its end."""


def sections(path, titles):
    """The sections of a file, in the order of `titles`: titles by name. A section of no such name is left out."""
    try:
        data = json.loads(path.read_text())
    except FileNotFoundError:
        raise Unreadable(f"there is no {path}") from None
    except (OSError, RecursionError, ValueError) as error:
        raise Unreadable(f"{path} is no JSON: {error}") from None
    schema = data.get("schema") if isinstance(data, dict) else None
    if schema not in READ:
        raise Unreadable(f"{path} has format {schema}; {' and '.join(map(str, READ))} are read")
    try:
        rows = data["sections"] if schema == SCHEMA else converted(data, titles)
        found = {section.name: section for section in value_of(list[Section], rows, "sections")}
    except (AttributeError, LookupError, TypeError, ValueError) as error:
        raise Unreadable(f"{path} is damaged: {type(error).__name__}: {error}") from None
    names = list(titles)
    for name, section in found.items():
        section.number = names.index(name) + 1 if name in names else 0
    return [found[name] for name in names if name in found]


def converted(data, titles):
    """Sections of format 1 as those of format 2."""
    run = {field.name: data[field.name] for field in dataclasses.fields(Run)}
    names = {title: name for name, title in titles.items()}
    return [{**row, "name": names.get(row["title"], ""), "run": run} for row in data["sections"]]


def value_of(kind, data, where):
    """Plain data as a value of the type; raises ValueError with the place of what is of another type."""
    if dataclasses.is_dataclass(kind):
        return instance_of(kind, data, where)
    origin, of = typing.get_origin(kind), typing.get_args(kind)
    if origin is types.UnionType:  # of one type and None, which no section of a file has
        return value_of(of[0], data, where)
    if origin is list:
        return [value_of(of[0], one, f"{where}[{k}]") for k, one in enumerate(typed(list, data, where))]
    if origin is tuple:
        return tuple(value_of(one, item, where) for one, item in zip(of, typed(list, data, where), strict=True))
    if kind is list:  # cells of a table
        return [one if one is None else figure(one, f"{where}[{k}]") for k, one in enumerate(typed(list, data, where))]
    if kind is dict:  # versions by name
        return {name: figure(one, f"{where}.{name}") for name, one in typed(dict, data, where).items()}
    return typed(kind, data, where)


def instance_of(kind, data, where):
    of = {field.name: field.type for field in dataclasses.fields(kind)}
    given = set(typed(dict, data, where)) - COMPUTED.get(kind, set())
    if given != set(of):
        raise ValueError(f"{where}: {', '.join(sorted(given ^ set(of)))} of too many or too few")
    return kind(**{name: value_of(one, data[name], f"{where}.{name}") for name, one in of.items()})


def figure(data, where):
    """A number, a word or `Missing`."""
    if isinstance(data, dict):
        return Missing(typed(str, data["missing"], where))
    return typed((int, float, str, bool), data, where)


def typed(kind, data, where):
    """The data, if it is of the type; a whole number is a float, too."""
    wanted = (int, float) if kind is float else kind
    if not isinstance(data, wanted) or (isinstance(data, bool) and kind in (int, float)):
        name = getattr(kind, "__name__", "a number or a word")
        raise ValueError(f"{where} is {type(data).__name__}, and {name} is needed")
    return data
