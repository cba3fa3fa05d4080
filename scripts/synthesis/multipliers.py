"""Multipliers in generic gates: a module of its own for each shape, mapped once however many there are, and held against plain multiplication."""

import random

from .tools import Failure

VECTORS = 1 << 16

# Yosys' $mul takes the place of itself, one floor further down. `A` and `B` have the same signedness.
MAP = r"""
(* techmap_celltype = "$mul" *)
module map_mul (A, B, Y);
  parameter A_SIGNED = 0, B_SIGNED = 0, A_WIDTH = 1, B_WIDTH = 1, Y_WIDTH = 1;
  input [A_WIDTH-1:0] A;
  input [B_WIDTH-1:0] B;
  output [Y_WIDTH-1:0] Y;
  wire _TECHMAP_FAIL_ = A_SIGNED != B_SIGNED;
  if (A_SIGNED) signed_multiplier #(.A_WIDTH(A_WIDTH), .B_WIDTH(B_WIDTH), .Y_WIDTH(Y_WIDTH)) product (.A(A), .B(B), .Y(Y));
  else unsigned_multiplier #(.A_WIDTH(A_WIDTH), .B_WIDTH(B_WIDTH), .Y_WIDTH(Y_WIDTH)) product (.A(A), .B(B), .Y(Y));
endmodule
"""
MODULES = "".join(f"""
(* multiplier, keep_hierarchy *)
module {name} (A, B, Y);
  parameter A_WIDTH = 1, B_WIDTH = 1, Y_WIDTH = 1;
  input {signed} [A_WIDTH-1:0] A;
  input {signed} [B_WIDTH-1:0] B;
  output [Y_WIDTH-1:0] Y;
  assign Y = A * B;
endmodule
""" for name, signed in (("signed_multiplier", "signed"), ("unsigned_multiplier", "")))

GATES = {
    "$_NOT_": lambda c: ~c["A"],
    "$_AND_": lambda c: c["A"] & c["B"],
    "$_NAND_": lambda c: ~(c["A"] & c["B"]),
    "$_OR_": lambda c: c["A"] | c["B"],
    "$_NOR_": lambda c: ~(c["A"] | c["B"]),
    "$_XOR_": lambda c: c["A"] ^ c["B"],
    "$_XNOR_": lambda c: ~(c["A"] ^ c["B"]),
    "$_MUX_": lambda c: (c["A"] & ~c["S"]) | (c["B"] & c["S"]),
    "$_AOI3_": lambda c: ~((c["A"] & c["B"]) | c["C"]),
    "$_OAI3_": lambda c: ~((c["A"] | c["B"]) & c["C"]),
}


def is_multiplier(name):
    """Whether a module of a netlist is one of these."""
    return name.endswith(("\\signed_multiplier", "\\unsigned_multiplier"))


def shape(module):
    """Widths of its factors."""
    return tuple(len(module["ports"][port]["bits"]) for port in "AB")


def behavioural(name, module):
    """The module as plain multiplication, in Verilog."""
    signed = "" if "\\unsigned" in name else "signed"
    a, b, y = (len(module["ports"][port]["bits"]) for port in "ABY")
    return f"module \\{name} (input {signed} [{a - 1}:0] A, input {signed} [{b - 1}:0] B, output [{y - 1}:0] Y);\n  assign Y = A * B;\nendmodule\n"


def verify(name, module):
    """Raises if the gates of a multiplier differ from the product on any of many pairs of factors, all pairs of extreme ones among them."""
    a_bits, b_bits, y_bits = (module["ports"][port]["bits"] for port in "ABY")
    signed = "\\unsigned" not in name
    draw = random.Random(1)
    pairs = [(a, b) for a in extremes(len(a_bits)) for b in extremes(len(b_bits))]
    pairs += [(draw.getrandbits(len(a_bits)), draw.getrandbits(len(b_bits))) for _ in range(VECTORS)]
    # Bit-sliced: one integer holds one bit of all pairs.
    mask = (1 << len(pairs)) - 1
    nets = {"0": 0, "1": mask}
    for bits, column in ((a_bits, 0), (b_bits, 1)):
        for k, bit in enumerate(bits):
            nets[bit] = slice_of(pair[column] >> k & 1 for pair in pairs)
    evaluate(module["cells"].values(), nets, mask)
    a_weight, b_weight = (1 << len(bits) if signed else 0 for bits in (a_bits, b_bits))
    products = [(a - (a_weight if 2 * a >= a_weight > 0 else 0)) * (b - (b_weight if 2 * b >= b_weight > 0 else 0)) for a, b in pairs]
    for k, bit in enumerate(y_bits):
        if nets[bit] != slice_of(product >> k & 1 for product in products):
            raise Failure(f"the gates of {name} do not multiply: bit {k} of the product")


def extremes(width):
    """Factors of a width that go wrong first."""
    top = 1 << (width - 1)
    return sorted({0, 1, top - 1, top, 2 * top - 1, (2 * top) // 3, *(1 << k for k in range(width))})


def slice_of(bits):
    """One integer of many bits, the first lowest."""
    return int("".join("1" if bit else "0" for bit in bits)[::-1], 2)


def evaluate(cells, nets, mask):
    """Values of all nets, from those of the inputs."""
    waiting = list(cells)
    while waiting:
        later = []
        for cell in waiting:
            inputs = {port: bits[0] for port, bits in cell["connections"].items() if port != "Y"}
            if all(bit in nets for bit in inputs.values()):
                nets[cell["connections"]["Y"][0]] = GATES[cell["type"]]({port: nets[bit] for port, bit in inputs.items()}) & mask
            else:
                later.append(cell)
        if len(later) == len(waiting):
            raise Failure("a multiplier's gates form a loop")
        waiting = later
