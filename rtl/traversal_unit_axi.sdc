# The unit behind AXI, at 100 MHz: one clock; every port is timed against it, with a fifth of the cycle outside.
# All outputs depend on registers alone, and but for busy_o, ready_o, reads_busy_o, read_error_o and axi_rready_o (constant) come from one: no path leads through from one side of the bus to the other.
create_clock -name clk_i -period 10.0 [get_ports clk_i]
set_input_delay 2.0 -clock clk_i [get_ports {rst_ni scene_i* base_i* flush_i valid_i in_i* secondary_i* ready_i axi_arready_i axi_rvalid_i axi_rid_i* axi_rdata_i* axi_rresp_i* axi_rlast_i}]
set_output_delay 2.0 -clock clk_i [get_ports {busy_o ready_o valid_o out_o* corners_o* reads_busy_o read_error_o axi_arvalid_o axi_arid_o* axi_araddr_o* axi_arlen_o* axi_arsize_o* axi_arburst_o* axi_arcache_o* axi_arprot_o* axi_rready_o}]
