// The ECP5's multiplier and register, with their registers, enables and resets as the manual of the FPGA has them, to compare two netlists by (same.py). The product is another
// function of both factors, which a solver sees through: neither netlist looks into the multiplier, and what holds for any function holds for a product.
module MULT18X18D(
  input A0, A1, A2, A3, A4, A5, A6, A7, A8, A9, A10, A11, A12, A13, A14, A15, A16, A17, B0, B1, B2, B3, B4, B5, B6, B7, B8, B9, B10, B11, B12, B13, B14, B15, B16, B17,
  C0, C1, C2, C3, C4, C5, C6, C7, C8, C9, C10, C11, C12, C13, C14, C15, C16, C17, SIGNEDA, SIGNEDB, SOURCEA, SOURCEB, CLK0, CE0, CE1, CE2, RST0,
  output P0, P1, P2, P3, P4, P5, P6, P7, P8, P9, P10, P11, P12, P13, P14, P15, P16, P17, P18, P19, P20, P21, P22, P23, P24, P25, P26, P27, P28, P29, P30, P31, P32, P33, P34, P35
);
  parameter REG_INPUTA_CLK = "NONE", REG_INPUTB_CLK = "NONE", REG_OUTPUT_CLK = "NONE";
  parameter REG_INPUTA_CE = "CE0", REG_INPUTB_CE = "CE0", REG_OUTPUT_CE = "CE0";
  parameter REG_INPUTA_RST = "RST0", REG_INPUTB_RST = "RST0", REG_OUTPUT_RST = "RST0", GSR = "ENABLED";
  wire [17:0] a_i = {A17, A16, A15, A14, A13, A12, A11, A10, A9, A8, A7, A6, A5, A4, A3, A2, A1, A0};
  wire [17:0] b_i = {B17, B16, B15, B14, B13, B12, B11, B10, B9, B8, B7, B6, B5, B4, B3, B2, B1, B0};
  wire enable_a = REG_INPUTA_CE == "CE0" ? CE0 : REG_INPUTA_CE == "CE1" ? CE1 : CE2;
  wire enable_b = REG_INPUTB_CE == "CE0" ? CE0 : REG_INPUTB_CE == "CE1" ? CE1 : CE2;
  wire enable_p = REG_OUTPUT_CE == "CE0" ? CE0 : REG_OUTPUT_CE == "CE1" ? CE1 : CE2;
  reg [17:0] a_q, b_q;
  reg [35:0] p_q;
  wire [17:0] a = REG_INPUTA_CLK == "NONE" ? a_i : a_q;
  wire [17:0] b = REG_INPUTB_CLK == "NONE" ? b_i : b_q;
  wire [35:0] p = {a ^ {SIGNEDA, 17'd0}, b ^ {SIGNEDB, 17'd0}} ^ {b, a << 1};
  always @(posedge CLK0) begin
    if (RST0) a_q <= 18'd0;
    else if (enable_a) a_q <= a_i;
    if (RST0) b_q <= 18'd0;
    else if (enable_b) b_q <= b_i;
    if (RST0) p_q <= 36'd0;
    else if (enable_p) p_q <= p;
  end
  assign {P35, P34, P33, P32, P31, P30, P29, P28, P27, P26, P25, P24, P23, P22, P21, P20, P19, P18, P17, P16, P15, P14, P13, P12, P11, P10, P9, P8, P7, P6, P5, P4, P3, P2, P1, P0}
    = REG_OUTPUT_CLK == "NONE" ? p : p_q;
endmodule

module TRELLIS_FF(input CLK, LSR, CE, DI, M, output reg Q);
  parameter GSR = "ENABLED", CLKMUX = "CLK", LSRMUX = "LSR", SRMODE = "LSR_OVER_CE", REGSET = "RESET";
  parameter [127:0] CEMUX = "1", LSRMODE = "LSR";
  wire enable = CEMUX == "CE" ? CE : 1'b1;
  always @(posedge CLK)
    if (LSR && (SRMODE == "LSR_OVER_CE" || enable)) Q <= REGSET == "SET";
    else if (enable) Q <= DI;
endmodule
