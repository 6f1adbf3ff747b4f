"""Contents of the files of a VtkWriter according to VTK's own reader, as lines of words:  vtk_read.py RUN.pvd

For each state:  state TIME POINTS CELLS VOLUME XMIN XMAX YMIN YMAX ZMIN ZMAX
and each array:  array point|cell NAME COMPONENTS MIN MAX     (of a vector its length; NaNs omitted)
Exits with 77 if this python has no VTK (Debian: python3-vtk9), with 1 if VTK cannot read a file.

"""

import sys
import xml.etree.ElementTree
from pathlib import Path

try:
    from vtkmodules.vtkFiltersCore import vtkMassProperties, vtkTriangleFilter
    from vtkmodules.vtkFiltersGeometry import vtkGeometryFilter
    from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader
except ImportError:
    sys.exit(77)


def volume(grid):
    """Volume that the surfaces enclose [m³]."""
    surface, triangles, mass = vtkGeometryFilter(), vtkTriangleFilter(), vtkMassProperties()
    surface.SetInputData(grid)
    triangles.SetInputConnection(surface.GetOutputPort())
    mass.SetInputConnection(triangles.GetOutputPort())
    mass.Update()
    return mass.GetVolume()


def main(collection):
    errors = []
    for entry in xml.etree.ElementTree.parse(collection).getroot().iter("DataSet"):
        reader = vtkXMLUnstructuredGridReader()
        reader.AddObserver("ErrorEvent", lambda *_: errors.append(entry.get("file")))
        reader.SetFileName(str(collection.parent / entry.get("file")))
        reader.Update()
        grid = reader.GetOutput()
        print("state", entry.get("timestep"), grid.GetNumberOfPoints(), grid.GetNumberOfCells(), volume(grid), *grid.GetBounds())
        for where, data in ("point", grid.GetPointData()), ("cell", grid.GetCellData()):
            for i in range(data.GetNumberOfArrays()):
                array = data.GetArray(i)
                components = array.GetNumberOfComponents()
                print("array", where, array.GetName(), components, *array.GetRange(-1 if components > 1 else 0))
    return 1 if errors else 0


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1])))
