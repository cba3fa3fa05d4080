# The unit behind AXI, at 100 MHz: one clock; every port is timed against it, with a fifth of the cycle outside.
# All outputs but view_o, which view_context_i chooses, depend on registers alone, and but for busy_o, memory_fault_o, view_o, ready_o, reads_busy_o, read_error_o and axi_rready_o (constant) come from one: no path leads through from one side of the bus to the other.
create_clock -name clk_i -period 10.0 [get_ports clk_i]
# Jitter and skew: what is left of the period to the logic is your clock tree's to say.
set_clock_uncertainty -setup 0.2 [get_clocks clk_i]
set_clock_uncertainty -hold 0.1 [get_clocks clk_i]
set_input_delay 2.0 -clock clk_i [get_ports {rst_ni scene_i* base_i* flush_i memory_test_i* view_context_i* counters_clear_i valid_i in_i* secondary_i* ready_i axi_arready_i axi_rvalid_i axi_rid_i* axi_rdata_i* axi_rresp_i* axi_rlast_i}]
set_output_delay 2.0 -clock clk_i [get_ports {busy_o memory_fault_o view_o* counters_o* ready_o valid_o out_o* corners_o* reads_busy_o read_error_o axi_arvalid_o axi_arid_o* axi_araddr_o* axi_arlen_o* axi_arsize_o* axi_arburst_o* axi_arcache_o* axi_arprot_o* axi_rready_o}]
# Scene and base stand still from the cycle before a ray is taken (docs/integration.md, held by rules/): two cycles for their paths, as they decide nothing while no ray is under way.
set_multicycle_path -setup 2 -from [get_ports {scene_i* base_i*}]
set_multicycle_path -hold 1 -from [get_ports {scene_i* base_i*}]
# But for scene_i.answer_limit, its lowest bits: ticks are counted by it in every cycle, also while contexts rest without a ray.
set_multicycle_path -setup 1 -from [get_ports {scene_i[0] scene_i[1] scene_i[2] scene_i[3] scene_i[4] scene_i[5] scene_i[6] scene_i[7] scene_i[8] scene_i[9] scene_i[10] scene_i[11] scene_i[12] scene_i[13] scene_i[14] scene_i[15] scene_i[16] scene_i[17] scene_i[18] scene_i[19]}]
set_multicycle_path -hold 0 -from [get_ports {scene_i[0] scene_i[1] scene_i[2] scene_i[3] scene_i[4] scene_i[5] scene_i[6] scene_i[7] scene_i[8] scene_i[9] scene_i[10] scene_i[11] scene_i[12] scene_i[13] scene_i[14] scene_i[15] scene_i[16] scene_i[17] scene_i[18] scene_i[19]}]
