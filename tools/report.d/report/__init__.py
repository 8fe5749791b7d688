"""The measurements of `tools/report`: speed against error, for the program and its peers.

rows ── noise          the figures and their verdicts: no process, no file
turns, budget          rounds of all competitors in turn; the time of each section
program, peers         processes: `selvedge`, and the others; absent ones are listed
views, scenes          the same cameras and solids for all
sections/              one section of the report a file; each gives `rows.Section`
peer/                  code that runs inside a peer's process, or the kernel's
markdown, plots        the output
stored                 benchmarks.json read back: the sections that a run does not measure
"""
