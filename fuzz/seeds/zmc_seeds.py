"""Inputs of shape3d_fuzz_zmc: fields in the order in which zmc_case.cpp reads them."""

import itertools
import random
import struct

SIGNS, SMALL, RAW, SPECIALS = range(4)


def case(dims, kind, alphabet, choices, samples, threads=0, isa=2, planes=2, layout=0, gap=0, axis=0, plane=0,
         isovalue=b"\0", second=b"\1\5", large=1):
    """large: 0, 1 or 8 for at most 4500, 800 or 200 samples."""
    head = bytes([dims[0] - 2, dims[1] - 2, dims[2] - 2, large, kind, alphabet, choices, threads, isa, planes, layout,
                  gap, axis, plane])
    return head + isovalue + second + bytes(samples)


def seeds():
    rng = random.Random(1)
    noise = [rng.randrange(256) for _ in range(200)]
    # Every option with every alphabet.
    for alphabet, choices in itertools.product(range(4), range(0, 256, 11)):
        kind = (alphabet * 5 + choices) % 7
        yield "zmc", f"options_{alphabet}_{choices:03}", case(
            (5, 4, 6), kind, alphabet, choices, noise[:60], threads=choices % 3, isa=choices % 3, planes=choices % 8,
            layout=choices % 48, gap=choices % 3, axis=choices % 3)
    # Rows round the widths of words; a volume that threads share.
    for length in (2, 31, 32, 33, 63, 64, 65, 127, 128, 129, 140):
        yield "zmc", f"row_{length}", case((length, 3, 3), 2, SMALL, 0, noise)
    yield "zmc", "shared", case((60, 10, 10), 2, SIGNS, 0, noise, threads=2, large=0)
    yield "zmc", "shared_mask", case((60, 10, 10), 5, SPECIALS, 0, noise, threads=2, large=0)
    # Blocks of zeros between both signs, and zeros alone.
    blocks = [0b00000000] * 40 + [0b01010101] * 20 + [0b11111111] * 20
    for choices in (0, 4, 8, 12, 16, 64, 128, 144):
        yield "zmc", f"blocks_{choices}", case((7, 6, 8), 0, SIGNS, choices, blocks)
    yield "zmc", "zeros", case((6, 5, 4), 3, SIGNS, 0, [0])
    # Isovalues that the type cannot hold, and reals of any size.
    for n, value in enumerate((0.5, 1e30, -1e-30, 2.0**-1060)):
        yield "zmc", f"isovalue_{n}", case((6, 5, 4), 6, SPECIALS, n, noise, isovalue=b"\5" + struct.pack("<d", value))
