"""Inputs of the fuzz targets of volume files, from the definitions of the formats."""

import base64
import gzip
import struct
import zlib

NEXT_FILE = b"\n--next file--\n"
DIMS = (3, 4, 2)
COUNT = DIMS[0] * DIMS[1] * DIMS[2]
# NumPy-like codes of struct: b B h H i I q Q f d.
SIZES = {code: struct.calcsize("<" + code) for code in "bBhHiIqQfd"}


def values(code, order="<"):
    signed = code in "bhiqfd"
    numbers = [(7 * n) % 50 - (20 if signed else 0) for n in range(COUNT)]
    return struct.pack(order + str(COUNT) + code, *numbers)


# --- NIfTI ---------------------------------------------------------------------------------------

NIFTI_TYPES = {"b": 256, "B": 2, "h": 4, "H": 512, "i": 8, "I": 768, "q": 1024, "Q": 1280, "f": 16, "d": 64}
SROW = (0.5, 0.1, 0, -3, 0, 0.75, 0.2, 7, 0.1, 0, 2, 11)


def nifti1(code, order="<", pair=False, sform=1, qform=0, slope=0.0, intercept=0.0, units=2, dims=DIMS):
    header = bytearray(348)
    struct.pack_into(order + "i", header, 0, 348)
    struct.pack_into(order + "8h", header, 40, 3, *dims, 1, 1, 1, 1)
    struct.pack_into(order + "2h", header, 70, NIFTI_TYPES[code], 8 * SIZES[code])
    struct.pack_into(order + "8f", header, 76, -1.0, 0.5, 0.75, 2.0, 1, 1, 1, 1)
    struct.pack_into(order + "3f", header, 108, 0.0 if pair else 352.0, slope, intercept)
    header[123] = units
    struct.pack_into(order + "2h", header, 252, qform, sform)
    struct.pack_into(order + "6f", header, 256, 0.1, 0.2, 0.3, 1, 2, 3)
    struct.pack_into(order + "12f", header, 280, *SROW)
    header[344:348] = b"ni1\0" if pair else b"n+1\0"
    return bytes(header) + (b"" if pair else bytes(4))


def nifti2(code, order="<"):
    header = bytearray(540)
    struct.pack_into(order + "i", header, 0, 540)
    header[4:12] = b"n+2\0\r\n\x1a\n"
    struct.pack_into(order + "2h", header, 12, NIFTI_TYPES[code], 8 * SIZES[code])
    struct.pack_into(order + "8q", header, 16, 3, *DIMS, 1, 1, 1, 1)
    struct.pack_into(order + "8d", header, 104, 1.0, 0.5, 0.75, 2.0, 1, 1, 1, 1)
    struct.pack_into(order + "q", header, 168, 544)
    struct.pack_into(order + "2d", header, 176, 2.0, -1.0)
    struct.pack_into(order + "2i", header, 344, 0, 1)
    struct.pack_into(order + "12d", header, 400, *SROW)
    struct.pack_into(order + "i", header, 500, 3)
    return bytes(header) + bytes(4)


def nifti():
    for code in NIFTI_TYPES:
        yield f"nifti_{code}", nifti1(code) + values(code)
    yield "nifti_big", nifti1("h", ">", qform=1, sform=0) + values("h", ">")
    yield "nifti_scaled", nifti1("h", slope=0.5, intercept=-7.0, units=1) + values("h")
    yield "nifti_steps", nifti1("B", slope=3.0, intercept=100.0) + values("B")
    yield "nifti_no_frame", nifti1("f", sform=0) + values("f")
    yield "nifti_gz", gzip.compress(nifti1("h") + values("h"), mtime=0)
    yield "nifti_pair", nifti1("h", pair=True) + NEXT_FILE + values("h")
    yield "nifti_pair_gz", nifti1("h", pair=True) + NEXT_FILE + gzip.compress(values("h"), mtime=0)
    yield "nifti_two", nifti2("i") + values("i")
    yield "nifti_two_big", nifti2("d", ">") + values("d", ">")
    yield "nifti_short", nifti1("h") + values("h")[:-1]
    yield "nifti_huge", nifti1("d", dims=(32767, 32767, 32767))


# --- NRRD ----------------------------------------------------------------------------------------

NRRD_TYPES = {"b": "signed char", "B": "uchar", "h": "short", "H": "uint16", "i": "int", "I": "uint32", "q": "longlong",
              "Q": "uint64", "f": "float", "d": "double"}
SPACE = "space: left-posterior-superior\nspace directions: (0.5,0,0) (0,0.75,0.1) (0,0,2)\nspace origin: (1,2,3)\n"


def nrrd_header(code, encoding="raw", more=SPACE, order="little"):
    sizes = " ".join(map(str, DIMS))
    return (f"NRRD0004\n# comment\ntype: {NRRD_TYPES[code]}\ndimension: 3\nsizes: {sizes}\n{more}"
            f"endian: {order}\nencoding: {encoding}\n").encode()


def nrrd():
    for code in NRRD_TYPES:
        yield f"nrrd_{code}", nrrd_header(code) + b"\n" + values(code)
    text = " ".join(str(n % 7 - 3) for n in range(COUNT)).encode()
    yield "nrrd_ascii", nrrd_header("h", "ascii") + b"\n" + text
    yield "nrrd_ascii_real", nrrd_header("d", "text") + b"\n" + b"1e300, nan -inf\n0.5 " * 6
    yield "nrrd_gzip", nrrd_header("h", "gzip") + b"\n" + gzip.compress(values("h"), mtime=0)
    yield "nrrd_big", nrrd_header("d", order="big") + b"\n" + values("d", ">")
    yield "nrrd_axes", nrrd_header("h", more="spacings: 0.5 0.75 2\naxis mins: 1 2 3\ncenterings: cell node cell\n"
                                   "kinds: domain domain domain\nunits: \"mm\" \"mm\" \"mm\"\n") + b"\n" + values("h")
    yield "nrrd_maxs", nrrd_header("h", more="axis mins: 1 2 3\naxis maxs: 4 5 6\nlabels: \"x\" \"y\" \"z\"\n"
                                   "content: some\nkey:=value\n") + b"\n" + values("h")
    yield "nrrd_space", nrrd_header("h", more="space dimension: 3\nspace units: \"cm\" \"cm\" \"cm\"\nspace directions: "
                                    "(0,1,0) (1,0,0) (0,0,-1)\nmeasurement frame: (1,0,0) (0,1,0) (0,0,1)\n") + b"\n" + values("h")
    yield "nrrd_frames", (nrrd_header("h", more="").replace(b"dimension: 3", b"dimension: 4")
                          .replace(b"sizes: ", b"sizes: 1 ") + b"\n" + values("h"))
    yield "nrrd_detached", nrrd_header("h", more=SPACE + "data file: input.img\n") + NEXT_FILE + values("h")
    yield "nrrd_skip", (nrrd_header("h", more=SPACE + "byte skip: -1\ndata file: input.img\n") + NEXT_FILE
                        + b"some bytes before\n" + values("h"))
    yield "nrrd_lines", (nrrd_header("h", more=SPACE + "line skip: 2\nbyte skip: 3\ndata file: input.img\n") + NEXT_FILE
                         + b"one\ntwo\nabc" + values("h"))
    half = len(values("h")) // 2
    yield "nrrd_list", (nrrd_header("h", more=SPACE + "encoding2: x\n") + b"data file: LIST 2\ninput.img\ndata2\n" + NEXT_FILE
                        + values("h")[:half] + NEXT_FILE + values("h")[half:])
    yield "nrrd_pattern", (nrrd_header("h", more=SPACE + "data file: data%d 2 3 1\n") + NEXT_FILE + b"" + NEXT_FILE
                           + values("h")[:half] + NEXT_FILE + values("h")[half:])


# --- MetaImage -----------------------------------------------------------------------------------

META_TYPES = {"b": "MET_CHAR", "B": "MET_UCHAR", "h": "MET_SHORT", "H": "MET_USHORT", "i": "MET_INT", "I": "MET_UINT",
              "q": "MET_LONG_LONG", "Q": "MET_ULONG_LONG", "f": "MET_FLOAT", "d": "MET_DOUBLE"}


def meta_header(code, data="LOCAL", more=""):
    sizes = " ".join(map(str, DIMS))
    return (f"ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\n"
            f"TransformMatrix = 0 1 0 1 0 0 0 0 -1\nOffset = 1 2 3\nCenterOfRotation = 0 0 0\n"
            f"ElementSpacing = 0.5 0.75 2\nDimSize = {sizes}\n{more}ElementType = {META_TYPES[code]}\n"
            f"ElementDataFile = {data}\n").encode()


def metaimage():
    for code in META_TYPES:
        yield f"meta_{code}", meta_header(code) + values(code)
    packed = zlib.compress(values("h"))
    yield "meta_zlib", meta_header("h", more=f"CompressedData = True\nCompressedDataSize = {len(packed)}\n") + packed
    yield "meta_big", meta_header("f").replace(b"MSB = False", b"MSB = True") + values("f", ">")
    yield "meta_text", meta_header("h").replace(b"BinaryData = True", b"BinaryData = False") + b"1 2 -3 4 " * 6
    yield "meta_file", meta_header("h", "input.img", "HeaderSize = -1\n") + NEXT_FILE + b"before" + values("h")
    yield "meta_scale", meta_header("B", more="ElementToIntensityFunctionSlope = 2\nElementToIntensityFunctionOffset = -5\n"
                                    "DistanceUnits = cm\nElementNumberOfChannels = 1\nComment = none\n") + values("B")
    half = len(values("h")) // 2
    yield "meta_list", (meta_header("h", "LIST 2\ninput.img\ndata2") + NEXT_FILE + values("h")[:half] + NEXT_FILE
                        + values("h")[half:])
    yield "meta_pattern", (meta_header("h", "data%1d 2 3 1") + NEXT_FILE + NEXT_FILE + values("h")[:half] + NEXT_FILE
                           + values("h")[half:])


# --- VTI -----------------------------------------------------------------------------------------

VTK_TYPES = {"b": "Int8", "B": "UInt8", "h": "Int16", "H": "UInt16", "i": "Int32", "I": "UInt32", "q": "Int64",
             "Q": "UInt64", "f": "Float32", "d": "Float64"}


def word(number, size=4):
    return struct.pack("<I" if size == 4 else "<Q", number)


def compressed_blocks(data, block, size=4):
    """Number of blocks, their size, the size of a last one that is not full, compressed sizes; the blocks."""
    blocks = [zlib.compress(data[n:n + block]) for n in range(0, len(data), block)]
    lengths = word(len(blocks), size) + word(block, size) + word(len(data) % block, size)
    return lengths + b"".join(word(len(b), size) for b in blocks), b"".join(blocks)


def vti_file(code, array, attributes="", appended="", extent=None, pieces=None):
    whole = extent or f"0 {DIMS[0] - 1} 0 {DIMS[1] - 1} 0 {DIMS[2] - 1}"
    body = "".join(
        f'<Piece Extent="{piece}"><PointData Scalars="s">'
        f'<DataArray type="{VTK_TYPES[code]}" Name="s" {content}</PointData><CellData></CellData></Piece>'
        for piece, content in (pieces or [(whole, array)]))
    return (f'<?xml version="1.0"?>\n<!-- volume -->\n<VTKFile type="ImageData" version="1.0" byte_order="LittleEndian" {attributes}>'
            f'<ImageData WholeExtent="{whole}" Origin="1 2 3" Spacing="0.5 0.75 2" Direction="1 0 0 0 1 0 0 0 1">'
            f'{body}</ImageData>{appended}</VTKFile>\n').encode()


def vti():
    text = " ".join(str((7 * n) % 50) for n in range(COUNT))
    for code in VTK_TYPES:
        yield f"ascii_{code}", vti_file(code, f'format="ascii">{text}</DataArray>')
    raw = values("h")
    encoded = base64.b64encode(word(len(raw)) + raw).decode()
    yield "binary", vti_file("h", f'format="binary">{encoded}</DataArray>', 'header_type="UInt32"')
    encoded64 = base64.b64encode(word(len(raw), 8) + raw).decode()
    yield "binary64", vti_file("h", f'format="binary">\n {encoded64}\n</DataArray>', 'header_type="UInt64"')
    for block in (len(raw), 10):
        lengths, blocks = compressed_blocks(raw, block)
        both = base64.b64encode(lengths).decode() + base64.b64encode(blocks).decode()
        zlib_attribute = 'compressor="vtkZLibDataCompressor"'
        yield f"zlib_{block}", vti_file("h", f'format="binary">{both}</DataArray>', zlib_attribute)
        yield f"appended_zlib_{block}", vti_file(
            "h", 'format="appended" offset="0"/>', zlib_attribute, f'<AppendedData encoding="base64">_{both}</AppendedData>')
        yield f"appended_raw_zlib_{block}", vti_file(
            "h", 'format="appended" offset="0"/>', zlib_attribute,
            '<AppendedData encoding="raw">_@</AppendedData>').replace(b"_@", b"_" + lengths + blocks)
    yield "appended", vti_file("h", 'format="appended" offset="0"/>', "",
                               f'<AppendedData encoding="base64">\n _{encoded}</AppendedData>')
    yield "appended_raw", vti_file("h", 'format="appended" offset="3"/>', 'header_type="UInt64"',
                                   '<AppendedData encoding="raw">_@</AppendedData>').replace(
                                       b"_@", b"_abc" + word(len(raw), 8) + raw)
    parts = [("0 2 0 3 0 1", 'format="ascii">' + "1 2 3 " * 8 + "</DataArray>"),
             ("0 2 0 3 1 2", 'format="ascii">' + "4 5 6 " * 8 + "</DataArray>")]
    yield "pieces", vti_file("B", "", extent="0 2 0 3 0 2", pieces=parts)
    yield "extent", vti_file("h", f'NumberOfComponents="1" RangeMin="0" format="ascii">{text}</DataArray>',
                             extent="-4 -2 5 8 100 101")


# --- DICOM ---------------------------------------------------------------------------------------

LONG_FORM = {b"OB", b"OW", b"SQ", b"UN", b"UT"}
EXPLICIT, IMPLICIT, BIG, RLE = (b"1.2.840.10008.1.2" + end for end in (b".1", b"", b".2", b".5"))
UNDEFINED = 0xffffffff


class Writer:
    def __init__(self, syntax):
        self.order = ">" if syntax == BIG else "<"
        self.explicit = syntax != IMPLICIT

    def tag(self, group, element):
        return struct.pack(self.order + "2H", group, element)

    def element(self, group, element, kind, value, length=None):
        if isinstance(value, int):
            value = struct.pack(self.order + ("H" if kind == b"US" else "I"), value)
        if len(value) % 2:
            value += b"\0" if kind in (b"UI", b"OB") else b" "
        size = len(value) if length is None else length
        if not self.explicit:
            return self.tag(group, element) + struct.pack(self.order + "I", size) + value
        if kind in LONG_FORM:
            return self.tag(group, element) + kind + bytes(2) + struct.pack(self.order + "I", size) + value
        return self.tag(group, element) + kind + struct.pack(self.order + "H", size) + value

    def item(self, value, undefined=False):
        if undefined:
            return self.tag(0xfffe, 0xe000) + b"\xff" * 4 + value + self.tag(0xfffe, 0xe00d) + bytes(4)
        return self.tag(0xfffe, 0xe000) + struct.pack(self.order + "I", len(value)) + value

    def sequence(self, group, element, items, undefined=False):
        value = b"".join(self.item(i, undefined) for i in items)
        if undefined:
            return self.element(group, element, b"SQ", value + self.tag(0xfffe, 0xe0dd) + bytes(4), UNDEFINED)
        return self.element(group, element, b"SQ", value)


def meta_group(syntax, storage, instance):
    w = Writer(EXPLICIT)
    body = (w.element(2, 1, b"OB", b"\0\1") + w.element(2, 2, b"UI", storage) + w.element(2, 3, b"UI", instance)
            + w.element(2, 0x10, b"UI", syntax))
    return bytes(128) + b"DICM" + w.element(2, 0, b"UL", len(body)) + body


def rle_frame(data, width):
    """Annex G of part 5: a segment for each byte of a sample, the highest first; literals alone."""
    segments = []
    for byte in reversed(range(width)):
        plane = data[byte::width]
        coded = b"".join(bytes([len(plane[n:n + 128]) - 1]) + plane[n:n + 128] for n in range(0, len(plane), 128))
        segments.append(coded + b"\0" * (len(coded) % 2))
    offsets, at = [], 64
    for segment in segments:
        offsets.append(at)
        at += len(segment)
    header = struct.pack("<16I", len(segments), *offsets, *[0] * (15 - len(segments)))
    return header + b"".join(segments)


def image_elements(w, rows, columns, bits, signed, frames=None):
    data = w.element(0x28, 2, b"US", 1) + w.element(0x28, 4, b"CS", b"MONOCHROME2")
    if frames:
        data += w.element(0x28, 8, b"IS", str(frames).encode())
    data += w.element(0x28, 0x10, b"US", rows) + w.element(0x28, 0x11, b"US", columns)
    if not frames:
        data += w.element(0x28, 0x30, b"DS", b"0.75\\0.5")
    return (data + w.element(0x28, 0x100, b"US", bits) + w.element(0x28, 0x101, b"US", bits)
            + w.element(0x28, 0x102, b"US", bits - 1) + w.element(0x28, 0x103, b"US", signed))


def dicom_slice(n, syntax=EXPLICIT, bits=16, signed=1, slope=None, series=b"1.2.3.4", extra=False, fragments=None):
    w = Writer(syntax)
    storage, instance = b"1.2.840.10008.5.1.4.1.1.2", b"1.2.3.4.%d" % n
    data = w.element(8, 0x16, b"UI", storage) + w.element(8, 0x18, b"UI", instance) + w.element(8, 0x60, b"CS", b"CT")
    if extra:
        inner = w.element(8, 0x100, b"SH", b"code") + w.sequence(0x40, 0xa730, [w.element(8, 0x104, b"LO", b"deep")], True)
        data += w.element(8, 0x103e, b"LO", b"description") + w.sequence(8, 0x1140, [inner, b""], extra == 2)
        data += w.element(9, 0x10, b"LO", b"PRIVATE") + w.element(9, 0x1001, b"UN", b"\1\2\3\4")
    data += (w.element(0x20, 0xd, b"UI", b"1.2.3") + w.element(0x20, 0xe, b"UI", series)
             + w.element(0x20, 0x11, b"IS", b"5") + w.element(0x20, 0x13, b"IS", b"%d" % (n + 1))
             + w.element(0x20, 0x32, b"DS", b"1\\2\\%d" % (3 + 2 * n)) + w.element(0x20, 0x37, b"DS", b"1\\0\\0\\0\\1\\0")
             + image_elements(w, 3, 4, bits, signed))
    if slope:
        data += w.element(0x28, 0x1052, b"DS", b"-1024") + w.element(0x28, 0x1053, b"DS", slope)
    pixels = bytes((13 * k + n) % 256 for k in range(12 * bits // 8))
    if fragments is not None or syntax == RLE:
        fragments = [rle_frame(pixels, bits // 8)] if fragments is None else fragments
        value = w.item(b"") + b"".join(w.item(f) for f in fragments) + w.tag(0xfffe, 0xe0dd) + bytes(4)
        data += w.element(0x7fe0, 0x10, b"OB", value, UNDEFINED)
    else:
        data += w.element(0x7fe0, 0x10, b"OW" if bits > 8 else b"OB", pixels)
    return meta_group(syntax, storage, instance) + data


def enhanced(undefined, frames=3):
    """Many frames with their functional groups."""
    w = Writer(EXPLICIT)
    storage, instance = b"1.2.840.10008.5.1.4.1.1.2.1", b"1.2.3.4.9"
    shared = (w.sequence(0x20, 0x9116, [w.element(0x20, 0x37, b"DS", b"1\\0\\0\\0\\1\\0")], undefined)
              + w.sequence(0x28, 0x9110, [w.element(0x28, 0x30, b"DS", b"0.75\\0.5")], undefined)
              + w.sequence(0x28, 0x9145, [w.element(0x28, 0x1052, b"DS", b"-10") + w.element(0x28, 0x1053, b"DS", b"2")],
                           undefined))
    per_frame = [w.sequence(0x20, 0x9113, [w.element(0x20, 0x32, b"DS", b"0\\0\\%d" % (2 * n))], undefined)
                 for n in range(frames)]
    data = (w.element(8, 0x16, b"UI", storage) + w.element(8, 0x18, b"UI", instance) + w.element(8, 0x60, b"CS", b"CT")
            + w.element(0x20, 0xe, b"UI", b"1.2.3.9") + image_elements(w, 3, 4, 16, 0, frames)
            + w.sequence(0x5200, 0x9229, [shared], undefined) + w.sequence(0x5200, 0x9230, per_frame, undefined)
            + w.element(0x7fe0, 0x10, b"OW", bytes(range(24)) * frames))
    return meta_group(EXPLICIT, storage, instance) + data


def dicom():
    def series(**options):
        return NEXT_FILE.join(dicom_slice(n, **options) for n in range(2))

    yield "explicit", series()
    yield "implicit", series(syntax=IMPLICIT)
    yield "big", series(syntax=BIG)
    yield "rle", series(syntax=RLE)
    yield "rle_byte", series(syntax=RLE, bits=8, signed=0)
    yield "bits_8", series(bits=8, signed=0)
    yield "bits_32", series(bits=32)
    yield "scaled", series(slope=b"0.5", signed=0)
    yield "steps", series(slope=b"2")
    yield "sequences", series(extra=1)
    yield "sequences_undefined", series(extra=2)
    yield "no_preamble", NEXT_FILE.join(dicom_slice(n)[132:] for n in range(2))
    yield "jpeg", series(syntax=b"1.2.840.10008.1.2.4.70", fragments=[b"\xff\xd8\xff\xc3\0\x0b\x10\0\3\0\4\1\1\x11\0\xff\xd9"])
    yield "enhanced", enhanced(False)
    yield "enhanced_undefined", enhanced(True)
    yield "two_series", dicom_slice(0) + NEXT_FILE + dicom_slice(1) + NEXT_FILE + dicom_slice(2, series=b"1.2.3.5")
    yield "copies", dicom_slice(0) + NEXT_FILE + dicom_slice(1) + NEXT_FILE + dicom_slice(1)
    yield "one", dicom_slice(0)


def seeds():
    for generate in (nifti, nrrd, metaimage):
        for name, data in generate():
            yield "volume", name, data
    for name, data in vti():
        yield "vti", name, data
    for name, data in dicom():
        yield "dicom", name, data
