"""Makes fish.png, fish-bent.png, clover.png, clover-turned.png and their list silhouettes.csv here."""

from pathlib import Path

import numpy as np
from tautline._shapes import as_image
from tautline.studies._silhouettes import mask
from vtkmodules.vtkImagingCore import vtkImageCast
from vtkmodules.vtkIOImage import vtkPNGWriter


#: The outline of a fish from the nose over the back to the tail and back along the belly, x y.
_FISH = [(52, 0), (44, 9), (30, 16), (16, 19), (8, 30), (-2, 29), (-6, 17), (-22, 9), (-34, 6), (-52, 20), (-47, 1),
         (-52, -17), (-34, -5), (-20, -10), (-2, -17), (2, -26), (10, -25), (14, -17), (30, -13), (44, -7)]  # fmt: skip


def fish(bend: float) -> np.ndarray:
    """The fish, bent as a parabola."""
    curve = np.array(_FISH, float)
    curve[:, 1] += bend * (curve[:, 0] / 30) ** 2
    return curve + (64, 64 - bend)


def clover(angle: float) -> np.ndarray:
    t = np.linspace(0, 2 * np.pi, 300, endpoint=False)
    r = 36 * (1 + 0.33 * np.cos(3 * (t - angle)))
    return np.stack([64 + r * np.cos(t), 64 + r * np.sin(t)], axis=1)


def main() -> None:
    here = Path(__file__).parent
    shapes = {"fish": fish(0), "fish-bent": fish(9), "clover": clover(0), "clover-turned": clover(0.6)}
    for name, curve in shapes.items():
        cast = vtkImageCast()
        cast.SetInputData(as_image(mask(curve)))
        cast.SetOutputScalarTypeToUnsignedChar()
        writer = vtkPNGWriter()
        writer.SetInputConnection(cast.GetOutputPort())
        writer.SetFileName(str(here / f"{name}.png"))
        writer.Write()
    rows = [f"{name}.png,{name.split('-')[0]}" for name in shapes]
    (here / "silhouettes.csv").write_text("\n".join(["file,class", *rows]) + "\n")


if __name__ == "__main__":
    main()
