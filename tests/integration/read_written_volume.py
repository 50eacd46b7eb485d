#!/usr/bin/python3
"""Prints what nibabel reads of a NIfTI file: shape, the affines, the codes and the samples."""
import json
import sys

import nibabel

image = nibabel.load(sys.argv[1])
header = image.header
print(json.dumps({
    "shape": list(image.shape),
    "type": str(image.get_data_dtype()),
    "affine": image.affine.tolist(),
    "qform": header.get_qform(coded=True)[0].tolist() if header["qform_code"] > 0 else None,
    "sform_code": int(header["sform_code"]),
    "unit": header.get_xyzt_units()[0],
    "samples": image.get_fdata().ravel(order="F").tolist(),
}))
