#!/usr/bin/env python3
"""Writes a STEP file of one plane with many round holes, in rows and columns: a perforated sheet.

    tools/many_loops.py OUT.step HOLES

`selvedge info OUT.step` reads 100,000 holes in less than five seconds on two cores; a time that grows faster than their
number is a defect. The sheet is as large as its holes need, 1 mm each, of radius 0.3 mm.
"""
import math
import sys

HEAD = """ISO-10303-21;
HEADER;
FILE_DESCRIPTION((''),'2;1');
FILE_NAME('holes','2026-01-01T00:00:00',(''),(''),'','','');
FILE_SCHEMA(('AUTOMOTIVE_DESIGN'));
ENDSEC;
DATA;
#1=(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.METRE.));
#2=(NAMED_UNIT(*)PLANE_ANGLE_UNIT()SI_UNIT($,.RADIAN.));
#3=(NAMED_UNIT(*)SI_UNIT($,.STERADIAN.)SOLID_ANGLE_UNIT());
#4=UNCERTAINTY_MEASURE_WITH_UNIT(LENGTH_MEASURE(1.E-5),#1,'distance_accuracy_value','');
#5=(GEOMETRIC_REPRESENTATION_CONTEXT(3)GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT((#4))\
GLOBAL_UNIT_ASSIGNED_CONTEXT((#1,#2,#3))REPRESENTATION_CONTEXT('',''));
#6=CARTESIAN_POINT('',(0.,0.,0.));
#7=DIRECTION('',(0.,0.,1.));
#8=DIRECTION('',(1.,0.,0.));
#9=AXIS2_PLACEMENT_3D('',#6,#7,#8);
#10=PLANE('',#9);
#11=APPLICATION_CONTEXT('automotive design');
#12=PRODUCT_CONTEXT('',#11,'mechanical');
#13=PRODUCT_DEFINITION_CONTEXT('part definition',#11,'design');
#14=PRODUCT('sheet','sheet','',(#12));
#15=PRODUCT_DEFINITION_FORMATION('','',#14);
#16=PRODUCT_DEFINITION('design','',#15,#13);
#17=PRODUCT_DEFINITION_SHAPE('','',#16);
"""


def listed(numbers: list[int]) -> str:
    return ",".join(f"#{number}" for number in numbers)


def main() -> None:
    if len(sys.argv) != 3 or not sys.argv[2].isdigit():
        sys.exit(__doc__)
    holes = int(sys.argv[2])
    side = max(math.ceil(math.sqrt(holes)), 1)
    last = 17
    bounds = []
    with open(sys.argv[1], "w", encoding="ascii") as out:

        def add(entity: str) -> int:
            nonlocal last
            last += 1
            out.write(f"#{last}={entity};\n")
            return last

        def point(x: float, y: float) -> int:
            return add(f"CARTESIAN_POINT('',({x!r},{y!r},0.))")

        def vertex(x: float, y: float) -> int:
            return add(f"VERTEX_POINT('',#{point(x, y)})")

        def bound(kind: str, edges: list[int]) -> None:
            uses = [add(f"ORIENTED_EDGE('',*,*,#{edge},.T.)") for edge in edges]
            loop = add(f"EDGE_LOOP('',({listed(uses)}))")
            bounds.append(add(f"{kind}('',#{loop},.T.)"))

        out.write(HEAD)
        corners = [(0.0, 0.0), (float(side), 0.0), (float(side), float(side)), (0.0, float(side))]
        vertices = [vertex(*corner) for corner in corners]
        sides = []
        for k, (x, y) in enumerate(corners):
            to = corners[(k + 1) % 4]
            along = add(f"DIRECTION('',({(to[0] - x) / side!r},{(to[1] - y) / side!r},0.))")
            vector = add(f"VECTOR('',#{along},1.)")
            line = add(f"LINE('',#{point(x, y)},#{vector})")
            sides.append(add(f"EDGE_CURVE('',#{vertices[k]},#{vertices[(k + 1) % 4]},#{line},.T.)"))
        bound("FACE_OUTER_BOUND", sides)
        for k in range(holes):
            x, y = k % side + 0.5, k // side + 0.5
            axes = add(f"AXIS2_PLACEMENT_3D('',#{point(x, y)},#7,#8)")
            circle = add(f"CIRCLE('',#{axes},0.3)")
            on = vertex(x + 0.3, y)
            bound("FACE_BOUND", [add(f"EDGE_CURVE('',#{on},#{on},#{circle},.F.)")])
        face = add(f"ADVANCED_FACE('',({listed(bounds)}),#10,.T.)")
        shell = add(f"OPEN_SHELL('',(#{face}))")
        model = add(f"SHELL_BASED_SURFACE_MODEL('',(#{shell}))")
        shape = add(f"MANIFOLD_SURFACE_SHAPE_REPRESENTATION('sheet',(#9,#{model}),#5)")
        add(f"SHAPE_DEFINITION_REPRESENTATION(#17,#{shape})")
        out.write("ENDSEC;\nEND-ISO-10303-21;\n")


if __name__ == "__main__":
    main()
