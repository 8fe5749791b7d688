"""One section of the report a file; each has `measure(context)`, which gives a `rows.Section`."""
