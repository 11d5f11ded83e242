"""Files that are no mesh, or are damaged: what is said of them is in the words of this program."""

import re
from pathlib import Path

import pytest

from meshes import read

L_WITH_HOLE = Path(__file__).parents[1] / "data" / "l_with_hole.msh"
UNREAD, DAMAGED = "{path} cannot be read as one: ", "it is damaged, or its parts do not fit together"
NO_NUMBER = "something in it that should be a number is none"
VTU = """<VTKFile type="UnstructuredGrid" version="0.1" byte_order="LittleEndian"><UnstructuredGrid>
<FieldData><DataArray type="Float64" Name="TIME" NumberOfTuples="1" format="ascii">0.5</DataArray></FieldData>
<Piece NumberOfPoints="3" NumberOfCells="4">
<Points><DataArray type="Float64" NumberOfComponents="3" format="ascii">0 0 0 1 0 0 0 1 0</DataArray></Points>
<Cells>
<DataArray type="Int64" Name="connectivity" format="ascii">0 1 2 0 1 1 2 2 0</DataArray>
<DataArray type="Int64" Name="offsets" format="ascii">3 5 7 9</DataArray>
<DataArray type="Int64" Name="types" format="ascii">5 3 3 3</DataArray>
</Cells>
<CellData><DataArray type="Int64" Name="boundary" format="ascii">0 7 7 8</DataArray></CellData>
</Piece></UnstructuredGrid></VTKFile>
"""
XDMF = """<Xdmf Version="3.0"><Domain><Grid><Geometry GeometryType="XY">
<DataItem Format="XML" Dimensions="3 2">0 0 1 0 0 1</DataItem></Geometry></Grid></Domain></Xdmf>
"""


def test_an_empty_file_is_told(tmp_path):
    (tmp_path / "mesh.xdmf").touch()
    with pytest.raises(ValueError, match="must be a mesh file; .*mesh.xdmf is empty"):
        read(tmp_path / "mesh.xdmf")


def test_a_folder_is_told(tmp_path):
    (tmp_path / "d.msh").mkdir()
    with pytest.raises(ValueError, match=r"\.xdmf file; \S+d\.msh is a folder$"):
        read(tmp_path / "d.msh")


@pytest.mark.parametrize(("kind", "values"), [("Float64", "0.5"), ("Int64", "7 1")])
def test_a_file_with_fields_such_as_the_time_is_read(tmp_path, kind, values):
    (tmp_path / "mesh.vtu").write_text(VTU.replace("Float64", kind, 1).replace("0.5", values))
    assert {name: len(edges) for name, edges in read(tmp_path / "mesh.vtu").boundaries.items()} == {"7": 2, "8": 1}


SOME_NAMED = """$MeshFormat
4.1 0 8
$EndMeshFormat
$PhysicalNames
1
2 7 "plate"
$EndPhysicalNames
$Entities
0 1 1 0
1 0 0 0 1 0 0 0 0
1 0 0 0 1 1 0 1 7 1 1
$EndEntities
$Nodes
1 3 1 3
2 1 0 3
1
2
3
0 0 0
1 0 0
0.5 0.5 0
$EndNodes
$Elements
2 2 1 2
1 1 1 1
1 1 2
2 1 2 1
2 1 2 3
$EndElements
"""
PARAMETRIC = """$MeshFormat
2.2 0 8
$EndMeshFormat
$ParametricNodes
1
1 0 0 0 0 1
$EndParametricNodes
$Elements
1
1 2 2 1 1 1 1 1
$EndElements
"""


@pytest.mark.parametrize(
    "name, content, message",
    [
        ("none.msh", None, "there is no file {path}"),
        ("case.toml", "[plate]", "got {path}"),
        ("all.msh", SOME_NAMED, UNREAD + "only some of its points, curves and surfaces are in a physical group; save"),
        ("parameters.msh", PARAMETRIC, UNREAD + "its nodes have parameters; save it in gmsh with Mesh.SaveParametric"),
        ("also.msh", SOME_NAMED.replace("2 1 0 3", "2 1 1 3"), UNREAD + "its nodes"),
        ("mesh.stl", "solid\nendsolid", "got {path}"),
        ("mesh.msh", "text", UNREAD + DAMAGED),
        ("old.msh", "$MeshFormat\n1.0 0 8\n$EndMeshFormat", UNREAD + "it is of gmsh 1.0; versions 2 and 4 are read"),
        ("word.msh", L_WITH_HOLE.read_text().replace("400 0 0", "400 x 0", 1), UNREAD + NO_NUMBER),
        ("cut.msh", L_WITH_HOLE.read_text()[:4000], UNREAD + DAMAGED),
        ("mesh.vtu", "text", UNREAD + DAMAGED),
        ("word.vtu", VTU.replace("0 0 0", "0 x 0", 1), UNREAD + NO_NUMBER),
        ("complex.vtu", VTU.replace("0 0 0", "0 1+2j 0", 1), UNREAD + NO_NUMBER),
        ("type.vtu", VTU.replace("Float64", "String"), UNREAD + "it has numbers of the type String, "),
        ("mesh.xdmf", "text", UNREAD + "its line 1 is no XML"),
        ("tags.xdmf", "<Xdmf>\n<Domain>\n</Xdmf>", UNREAD + "its line 3 is no XML"),
        ("cut.xdmf", "<Xdmf>\n<Domain>\n", UNREAD + "it ends too soon, in line 3"),
        ("short.xdmf", "<Xdmf>\n<Dom", UNREAD + "it ends too soon, in line 2"),
        ("other.xdmf", "<html/>", UNREAD + DAMAGED),
        ("plain.xdmf", "<Xdmf/>", UNREAD + "something in it lacks the attribute Version"),
        ("form.xdmf", XDMF.replace('Format="XML" ', ""), UNREAD + "something in it lacks the attribute Format"),
        ("old.xdmf", '<Xdmf Version="1.0"/>', UNREAD + "it is XDMF 1.0; versions 2 and 3 are read"),
        ("none.xdmf", '<Xdmf Version="3.0"><Domain/></Xdmf>', UNREAD + "it does not have one grid"),
    ],
)
def test_files_that_cannot_be_read_are_named(tmp_path, capfd, name, content, message):
    path = tmp_path / name
    if content is not None:
        path.write_text(content)
    wanted = "Input path of read must be a .msh file of gmsh, a .vtu or a first-order .xdmf file; "
    with pytest.raises(ValueError, match=re.escape(wanted + message.format(path=path))):
        read(path)
    assert capfd.readouterr() == ("", "")
