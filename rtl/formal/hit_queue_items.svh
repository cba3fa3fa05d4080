  // Inside hit_queue: its items, for a property of what is around it.
  logic [DEPTH-1:0][W-1:0] items;
  for (genvar k = 0; k < DEPTH; k++) begin : g_items
    assign items[k] = items_q[k];
  end
