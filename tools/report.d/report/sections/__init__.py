"""One section of the report a file; each has `measure(context)`, which returns a `rows.Section`."""
