"""What the project claims to win, by section: the only place of it. A contest that no rule here names claims nothing.

A lost claim makes a run fail, so a rule names what runs have won, and no more. What we are behind in comes first in the
document all the same, claimed or not, with the measurement that explains it.
"""

SMALL, MIDDLE = (960, 540), (1920, 1080)
# largest error of the boundary, pixels; the files, each of a megabyte and more, with the sizes of their pictures. At
# 3840x2160 nothing is claimed: a process that draws one plane takes about as long as a viewer takes for a file
FIRST_PICTURE_PX = 0.5
FIRST_PICTURE = {
    "nist_pmi_2.stp": [SMALL, MIDDLE],
    "framework_printable_case_full.stp": [SMALL, MIDDLE],
    "impeller.igs": [SMALL, MIDDLE],
}
# from this zoom on a mesh for the view takes longer than our frame, and a texture of the trim more than our bytes
CLOSE = 10


def sentences(section):
    """The claims of a section, as --only names it."""
    sizes = {", ".join(f"{width}x{height}" for width, height in sizes) for sizes in FIRST_PICTURE.values()}
    pictures = f"{', '.join(FIRST_PICTURE)}; {'; '.join(sizes)}"
    return {
        "surfaces": [f"first picture, within {FIRST_PICTURE_PX:g} px, beside every viewer: {pictures}"],
        "zoom": [f"frame, beside a mesh made for the zoom: from {CLOSE} times on"],
        "trims": [
            "trims, beside bisection: every file and zoom",
            f"memory, beside a trim texture: every file, from {CLOSE} times on",
        ],
        "solids": ["turning frame of way `events`, beside our two other ways: every scene"],
        "reading": ["reading, beside Open CASCADE: every file"],
    }.get(section, [])


def word(holds):
    """The `claim` of a contest."""
    return "ahead" if holds else "open"


def first_picture(file, size, error):
    return word(error <= FIRST_PICTURE_PX and tuple(size) in FIRST_PICTURE.get(file, []))


def frame_beside_a_mesh_for_the_zoom(zoom):
    return word(zoom >= CLOSE)


def memory_beside_a_texture(zoom):
    return word(zoom >= CLOSE)


# in every case
TRIMS = WAY_EVENTS = READING = "ahead"
