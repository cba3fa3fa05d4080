# The unit alone, at 100 MHz: one clock; every port is timed against it, with a fifth of the cycle outside.
# Outputs come from registers but for busy_o, memory_fault_o, view_o, ready_o, mem_ready_o (constant) and the operand of mem_o's register, so surroundings of one more level of logic fit.
create_clock -name clk_i -period 10.0 [get_ports clk_i]
# Jitter and skew: what is left of the period to the logic is your clock tree's to say.
set_clock_uncertainty -setup 0.2 [get_clocks clk_i]
set_clock_uncertainty -hold 0.1 [get_clocks clk_i]
set_input_delay 2.0 -clock clk_i [get_ports {rst_ni scene_i* flush_i memory_test_i* view_context_i* counters_clear_i valid_i in_i* secondary_i* ready_i mem_ready_i mem_valid_i mem_i*}]
set_output_delay 2.0 -clock clk_i [get_ports {busy_o memory_fault_o view_o* counters_o* ready_o valid_o out_o* corners_o* mem_valid_o mem_o* mem_ready_o}]
# The scene stands still from the cycle before a ray is taken (docs/integration.md, held by rules/traversal_unit_rules.sv): two cycles for its paths, as they decide nothing while no ray is
# under way.
set_multicycle_path -setup 2 -from [get_ports {scene_i*}]
set_multicycle_path -hold 1 -from [get_ports {scene_i*}]
# But for scene_i.answer_limit, its lowest bits: ticks are counted by it in every cycle, also while contexts rest without a ray.
set_multicycle_path -setup 1 -from [get_ports {scene_i[0] scene_i[1] scene_i[2] scene_i[3] scene_i[4] scene_i[5] scene_i[6] scene_i[7] scene_i[8] scene_i[9] scene_i[10] scene_i[11] scene_i[12] scene_i[13] scene_i[14] scene_i[15] scene_i[16] scene_i[17] scene_i[18] scene_i[19]}]
set_multicycle_path -hold 0 -from [get_ports {scene_i[0] scene_i[1] scene_i[2] scene_i[3] scene_i[4] scene_i[5] scene_i[6] scene_i[7] scene_i[8] scene_i[9] scene_i[10] scene_i[11] scene_i[12] scene_i[13] scene_i[14] scene_i[15] scene_i[16] scene_i[17] scene_i[18] scene_i[19]}]
