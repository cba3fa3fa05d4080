"""One ray through `traversal_unit_axi`: its hit, and the lines that it read, are those of the program's cycle model.

Everything is looked at and driven at falling edges. All outputs come from registers there, so a transfer happens at the next rising edge if valid and ready are both high now.
"""

import json
import os
import random
from pathlib import Path

import cocotb
from cocotb.clock import Clock
from cocotb.triggers import FallingEdge, with_timeout

# Where the scene's file lies in memory: any multiple of 32.
BASE = 0x12_3456_7000


class Memory:
    """An AXI4 memory, read only: takes requests every other cycle or so, and gives the beats of those under way in any order."""

    def __init__(self, dut, image: bytes, seed: int) -> None:
        self.dut, self.image, self.random = dut, image, random.Random(seed)
        self.lines = 0
        # Id, address of the next beat and beats left of each read under way.
        self.reads: list[list[int]] = []

    async def run(self) -> None:
        dut = self.dut
        dut.axi_arready_i.value = 0
        dut.axi_rvalid_i.value = 0
        while True:
            await FallingEdge(dut.clk_i)
            self.give()
            ready = self.random.random() < 0.5
            dut.axi_arready_i.value = int(ready)
            if ready and dut.axi_arvalid_o.value == 1:
                self.take()

    def take(self) -> None:
        """A request: a burst of whole beats (ARBURST = INCR)."""
        dut = self.dut
        assert dut.axi_arburst_o.value == 1 and 1 << int(dut.axi_arsize_o.value) == self.beat_bytes()
        self.reads.append([int(dut.axi_arid_o.value), int(dut.axi_araddr_o.value) - BASE, int(dut.axi_arlen_o.value) + 1])
        self.lines += 1

    def give(self) -> None:
        """A beat of any read, in three cycles of four: the byte with the lowest address in the lowest bits."""
        dut = self.dut
        if not self.reads or self.random.random() < 0.25:
            dut.axi_rvalid_i.value = 0
            return
        read = self.random.choice(self.reads)
        name, address, left = read
        assert 0 <= address < len(self.image), "a read outside of the file"
        dut.axi_rvalid_i.value = 1
        dut.axi_rid_i.value = name
        dut.axi_rdata_i.value = int.from_bytes(self.image[address : address + self.beat_bytes()], "little")
        dut.axi_rresp_i.value = 0
        dut.axi_rlast_i.value = int(left == 1)
        read[1:] = [address + self.beat_bytes(), left - 1]
        if left == 1:
            self.reads.remove(read)

    def beat_bytes(self) -> int:
        return len(self.dut.axi_rdata_i) // 8


async def trace(dut, ray: int) -> int:
    """The hit of a ray."""
    dut.in_i.value = ray
    dut.valid_i.value = 1
    # Offered until the unit has taken it.
    while dut.ready_o.value != 1:
        await FallingEdge(dut.clk_i)
    await FallingEdge(dut.clk_i)
    dut.valid_i.value = 0
    while dut.valid_o.value != 1:
        await FallingEdge(dut.clk_i)
    return int(dut.out_o.value)


@cocotb.test()
async def one_ray(dut) -> None:
    ports = json.loads(Path(os.environ["PORTS"]).read_text())
    word = {name: int(ports[name]["bits"], 16) for name in ("scene_i", "in_i", "out_o")}
    for name in word:
        assert len(getattr(dut, name)) == ports[name]["width"], f"{name} has {len(getattr(dut, name))} bits: another unit"
    memory = Memory(dut, Path(os.environ["SCENE"]).read_bytes(), seed=1)

    dut.scene_i.value = word["scene_i"]
    dut.base_i.value = BASE
    dut.flush_i.value = 0
    dut.memory_test_i.value = 0
    dut.view_context_i.value = 0
    dut.counters_clear_i.value = 0
    dut.valid_i.value = 0
    dut.ready_i.value = 1
    dut.rst_ni.value = 0
    cocotb.start_soon(Clock(dut.clk_i, 10, unit="ns").start())
    cocotb.start_soon(memory.run())
    for _ in range(2):
        await FallingEdge(dut.clk_i)
    dut.rst_ni.value = 1
    await FallingEdge(dut.clk_i)

    hit = await with_timeout(trace(dut, word["in_i"]), 10, "ms")
    assert hit == word["out_o"], f"out_o is {hit:#x}, not {word['out_o']:#x}"
    assert memory.lines == ports["lines"], f"{memory.lines} lines were read, not {ports['lines']}"
    dut._log.info("the hit came, after %d lines of memory", memory.lines)
