"""Sculpts a CAD file: sculpt.py IN.step OUT.step. Change the numbers to suit your part."""

import sys

import knead


def main(source: str, target: str) -> None:
    doc = knead.open(source)
    skin = max(doc.surfaces, key=lambda s: s.control_points.size)
    corners = skin.control_points.reshape(-1, 3)
    size = float(max(corners.max(axis=0) - corners.min(axis=0)))
    print(repr(skin))

    doc.select(skin.id).hold(mode="position")  # the edges of its faces stay
    doc.tool("ball", shape="sphere", radius=0.1 * size, at="middle")
    doc.move("ball", by=(0, 0, 0.07 * size))
    doc.step(15, lambda_=20, progress=sys.stderr.isatty())

    print(f"moved by up to {doc.report.largest_displacement:.4g} {skin.unit}")
    for note in doc.report.notes:
        print("note:", note)
    doc.save(target)


if __name__ == "__main__":
    try:
        main(*sys.argv[1:])
    except knead.Error as error:
        sys.exit(f"sculpt.py: {error}")
