"""Inputs of shape3d_fuzz_mesh: a byte that names the format, then the file."""

import base64
import struct
import zlib

POINTS = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1), (0.5, 0.25, -1e-3)]
FACES = [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)]
POLYGONS = FACES + [(0, 1, 4, 2), (1, 4), (0, 1, 2, 3, 4)]


def rows(values, separator="\n"):
    return separator.join(" ".join(str(x) for x in row) for row in values)


def faces_text(faces, first=0):
    return rows([[len(f), *(i + first for i in f)] for f in faces])


def off():
    yield "plain", f"OFF\n5 4 6\n{rows(POINTS)}\n{faces_text(FACES)}\n"
    yield "polygons", f"# SPACE=LPS\nOFF 5 7 0 # counts\n{rows(POINTS)}\n{faces_text(POLYGONS)}\n"
    yield "colours", f"OFF\n5 4 0\n{rows(POINTS)}\n" + "\n".join(f"3 {a} {b} {c} 255 0 0" for a, b, c in FACES)
    for prefix, extra in (("C", "1 0 0 1"), ("N", "0 0 1"), ("ST", "0.5 0.5"), ("STCN", "0 0 1 1 0 0 1 0.5 0.5")):
        yield prefix, f"{prefix}OFF\n5 4 0\n{rows([(*p, extra) for p in POINTS])}\n{faces_text(FACES)}\n"
    yield "numbers", f"OFF\n3 1 0\n+1e-320 -0.0 1E5\n.5 5. 1e308\n0x1 2 3\n3 0 1 2\n"
    yield "other", "4OFF\n1 0 0\n0 0 0 1\n"
    yield "binary", "OFF BINARY\n"
    yield "huge", "OFF\n2000000000 2000000000 0\n0 0 0\n"


def obj():
    v = "\n".join("v " + " ".join(map(str, p)) for p in POINTS)
    yield "plain", f"# comment SPACE=RAS\no name\n{v}\n" + "\n".join("f " + " ".join(str(i + 1) for i in f) for f in POLYGONS)
    yield "slashes", f"{v}\nvt 0 0\nvn 0 0 1\nusemtl m\ns off\ng a b\nf 1/1/1 2//1 3/1\nf 1 2 \\\n3\n"
    yield "negative", f"mtllib x.mtl\n{v}\nf -1 -2 -3\nl 1 2\np 1\nf 1 2\n"
    yield "colours", "v 0 0 0 1 0 0\nv 1 0 0 1 1 1\nv 0 1 0 1\nf 1 2 3\n"


def ply_header(encoding, vertex="double", index="uchar int vertex_indices", vertices=5, faces=4, more=""):
    return (f"ply\nformat {encoding} 1.0\ncomment SPACE=LPS\nobj_info none\nelement vertex {vertices}\n"
            + "".join(f"property {vertex} {axis}\n" for axis in "xyz") + more
            + f"element face {faces}\nproperty list {index}\nend_header\n")


def ply():
    yield "ascii", (ply_header("ascii") + f"{rows(POINTS)}\n{faces_text(FACES)}\n").encode()
    for order, name in (("<", "little"), (">", "big")):
        for kind, code in (("float", "f"), ("double", "d")):
            body = b"".join(struct.pack(order + "3" + code, *p) for p in POINTS)
            body += b"".join(struct.pack(order + f"B{len(f)}i", len(f), *f) for f in POLYGONS)
            yield f"{name}_{kind}", ply_header(f"binary_{name}_endian", kind, faces=len(POLYGONS)).encode() + body
    body = b"".join(struct.pack("<3hB2H", *map(int, p), 2, 7, 8) for p in POINTS)
    body += b"".join(struct.pack("<i3B", 3, *f) for f in FACES)
    yield "lists", ply_header("binary_little_endian", "short", "int uchar vertex_index",
                              more="property list uchar ushort neighbours\n").encode() + body
    yield "others", (ply_header("ascii", more="property uchar red\n").replace("end_header", "element edge 1\nproperty int "
                     "vertex1\nproperty list uchar float more\nend_header")
                     + f"{rows([(*p, 200) for p in POINTS])}\n{faces_text(FACES)}\n0 2 1.5 2.5\n").encode()
    yield "huge", ply_header("binary_little_endian", vertices=2000000000).encode()
    yield "strips", b"ply\nformat ascii 1.0\nelement vertex 0\nproperty int x\nproperty int y\nproperty int z\nelement tristrips 1\nproperty list int int vertex_indices\nend_header\n1 0\n"


def stl():
    facets = "".join("facet normal 0 0 1\nouter loop\n" + "".join("vertex " + " ".join(map(str, POINTS[i])) + "\n" for i in f)
                     + "endloop\nendfacet\n" for f in FACES)
    yield "ascii", f"solid name SPACE=RAS\n{facets}endsolid name\n".encode()
    yield "two", f"solid a\n{facets}endsolid\nsolid b\n{facets}endsolid b\n".encode()
    binary = b"".join(struct.pack("<12fH", 0, 0, 1, *(x for i in f for x in POINTS[i]), 0) for f in FACES)
    yield "binary", b"SPACE=LPS".ljust(80) + struct.pack("<I", len(FACES)) + binary
    yield "solid_binary", b"solid".ljust(80, b"\0") + struct.pack("<I", len(FACES)) + binary
    yield "degenerate", bytes(80) + struct.pack("<I", 1) + struct.pack("<12fH", *[0.0] * 12, 0)
    yield "empty", bytes(84)


def vtp_array(kind, name, content, more=""):
    return f'<DataArray type="{kind}" Name="{name}" {more} {content}'


def vtp_file(points, connectivity, offsets, attributes="", appended="", polys=len(FACES), data=""):
    return (f'<?xml version="1.0"?>\n<VTKFile type="PolyData" version="1.0" byte_order="LittleEndian" {attributes}><PolyData>'
            f'<FieldData><Array type="String" Name="SPACE" NumberOfTuples="1" format="ascii">76 80 83 0</Array></FieldData>'
            f'<Piece NumberOfPoints="{len(POINTS)}" NumberOfVerts="0" NumberOfLines="0" NumberOfStrips="0" '
            f'NumberOfPolys="{polys}">{data}<Points>{points}</Points><Polys>{connectivity}{offsets}</Polys></Piece>'
            f'</PolyData>{appended}</VTKFile>\n')


def vtp():
    ids = [i for f in FACES for i in f]
    ends = [3 * (n + 1) for n in range(len(FACES))]
    three = 'NumberOfComponents="3"'

    def text(values):
        return 'format="ascii">' + " ".join(map(str, values)) + "</DataArray>"

    flat = [x for p in POINTS for x in p]
    scalars = ('<PointData Scalars="a">' + vtp_array("Float64", "a", text(range(5))) + "</PointData><CellData>"
               + vtp_array("UInt8", "b", text(range(4))) + "</CellData>")
    yield "ascii", vtp_file(vtp_array("Float64", "Points", text(flat), three), vtp_array("Int32", "connectivity", text(ids)),
                            vtp_array("Int32", "offsets", text(ends)), data=scalars).encode()
    many = [i for f in POLYGONS for i in f]
    last = [sum(len(f) for f in POLYGONS[:n + 1]) for n in range(len(POLYGONS))]
    yield "polygons", vtp_file(vtp_array("Float32", "Points", text(flat), three), vtp_array("Int64", "connectivity", text(many)),
                               vtp_array("Int64", "offsets", text(last)), polys=len(POLYGONS)).encode()
    parts = [struct.pack("<15d", *flat), struct.pack("<12q", *ids), struct.pack("<4q", *ends)]
    starts = [0, len(parts[0]) + 8, len(parts[0]) + len(parts[1]) + 16]

    def placed(n):
        return f'format="appended" offset="{starts[n]}"/>'

    arrays = (vtp_array("Float64", "Points", placed(0), three), vtp_array("Int64", "connectivity", placed(1)),
              vtp_array("Int64", "offsets", placed(2)))
    raw = b"".join(struct.pack("<Q", len(p)) + p for p in parts)
    yield "appended", vtp_file(*arrays, 'header_type="UInt64"', '<AppendedData encoding="raw">_@</AppendedData>').encode(
        ).replace(b"_@", b"_" + raw)

    def packed(data):
        block = zlib.compress(data)
        return ('format="binary">' + base64.b64encode(struct.pack("<4I", 1, len(data), 0, len(block))).decode()
                + base64.b64encode(block).decode() + "</DataArray>")

    yield "zlib", vtp_file(vtp_array("Float64", "Points", packed(parts[0]), three),
                           vtp_array("Int64", "connectivity", packed(parts[1])),
                           vtp_array("Int64", "offsets", packed(parts[2])), 'compressor="vtkZLibDataCompressor"').encode()


def seeds():
    for letter, generate in (("o", off), ("w", obj), ("p", ply), ("s", stl), ("v", vtp)):
        for name, data in generate():
            data = data if isinstance(data, bytes) else data.encode()
            yield "mesh", f"{generate.__name__}_{name}", letter.encode() + data
