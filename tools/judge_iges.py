#!/usr/bin/env python3
"""judge.py for IGES files, whose faces it does not number: tools/judge_all calls this.

    ORACLE=oracle judge_iges.py MODEL.igs OPTIONS...      the options are those of judge.py

A face's number is that of the directory card of the 144, 143 or 510 that the kernel made it from. The kernel keeps
the entities in the file's order, and two cards are an entity.
"""
import os, sys

sys.path.insert(0, os.environ['ORACLE'])
import oracle as K
from OCP.IGESControl import IGESControl_Reader
from OCP.TopAbs import TopAbs_FACE
from OCP.TopExp import TopExp_Explorer

FACES = ('IGESGeom_TrimmedSurface', 'IGESGeom_BoundedSurface', 'IGESSolid_Face')


def load(path):
    """Like oracle.load, with numbers."""
    reader = IGESControl_Reader()
    if int(reader.ReadFile(path)) != 1:
        raise SystemExit('read failed')
    reader.TransferRoots()
    transfer, model = reader.WS().TransferReader(), reader.WS().Model()
    entities = [model.Value(i + 1) for i in range(model.NbEntities())]
    number = {id(entity): 2 * i + 1 for i, entity in enumerate(entities)}
    shape, faces = reader.OneShape(), []
    explorer = TopExp_Explorer(shape, TopAbs_FACE)
    while explorer.More():
        face = K.cast(explorer.Current())
        entity = transfer.EntityFromShapeResult(face, 1)
        if entity is None or entity.DynamicType().Name() not in FACES:
            raise SystemExit('a face of the kernel is of no entity that is a face')
        faces.append((face, number[id(entity)]))
        explorer.Next()
    return shape, faces, {}


def install():
    """Makes the kernel's reader number the faces of IGES files."""
    others = K.load
    K.load = lambda path: load(path) if path.lower().endswith(('.igs', '.iges')) else others(path)


if __name__ == '__main__':
    import judge
    install()
    judge.main()
