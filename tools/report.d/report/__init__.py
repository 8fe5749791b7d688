"""Speed against error, beside everybody else: what `tools/report` runs.

rows ── noise          what is measured, and whether it was won: no process, no file
turns                  rounds of all competitors in turn
program, peers         processes: `selvedge`, and the others, each told as missing where it is
views, scenes          the same cameras and solids for all
sections/              one section of the report a file; each gives `rows.Section`
peer/                  what runs inside a peer's process, or the kernel's
markdown, plots        what is written
"""
