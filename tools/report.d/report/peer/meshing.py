"""The limit of a mesher, which cannot be stopped but with its process."""

# a mesh ten times as fine takes up to so many times as long
GROWTH = 8.0


def stopped(last_s, most_s):
    """Why the next finer mesh is not made, after one that took `last_s`; None if there is time for it."""
    if last_s * GROWTH <= most_s:
        return None
    return f"the mesh before took {last_s:.1f} s; one that may take longer than {most_s:g} s is not made"
