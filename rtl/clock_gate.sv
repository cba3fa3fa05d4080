`default_nettype none

/// A clock that stands still while `enable_i` is low: the one place for a library's clock gate.
///
/// Without `GATED` it is the clock itself. With it a latch holds the enable while the clock is high, as in the cell that an ASIC flow puts in this module's place; an FPGA takes a clock
/// buffer with an enable. `enable_i` is settled before the rising edge that it lets through.
module clock_gate #(
  parameter bit GATED = 1'b0
) (
  input  logic clk_i,
  input  logic enable_i,
  output logic clk_o
);

  if (GATED) begin : g_gate
    logic enabled;
    always_latch begin
      if (!clk_i) enabled = enable_i;
    end
    assign clk_o = clk_i & enabled;
  end else begin : g_wire
    logic unused_enable;
    assign unused_enable = enable_i;
    assign clk_o         = clk_i;
  end

endmodule

`default_nettype wire
