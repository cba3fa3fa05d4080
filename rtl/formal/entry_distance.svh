  // Inside entry_distance, with the products free: the largest of the three, each shifted down and held at the largest number; it never falls when one grows.
  (* anyseq *) logic [2:0][PRODUCT_W-1:0] other;
  logic [2:0]                reached_by, above;
  logic [2:0][PRODUCT_W-1:0] entry, entry_other;
  logic [2:0][SHIFT_W-1:0]   right;
  localparam logic [PRODUCT_W-1:0] LARGEST = PRODUCT_W'({T_W{1'b1}});
  always_comb begin
    for (int unsigned k = 0; k < 3; k++) begin
      right[k]       = reciprocal_i[k][SHIFT_W-1:0];
      entry[k]       = (product[k] >> right[k]) > LARGEST ? LARGEST : product[k] >> right[k];
      entry_other[k] = (other[k] >> right[k]) > LARGEST ? LARGEST : other[k] >> right[k];
      reached_by[k]  = entry[k] == PRODUCT_W'(t_near_o);
      above[k]       = entry[k] > PRODUCT_W'(t_near_o) || (other[k] <= product[k] && entry_other[k] > PRODUCT_W'(t_near_o));
    end
  end

  always_comb begin
    assert (reached_by != '0 && above == '0);
    cover (t_near_o == '1 && reached_by == 3'b010 && right[1] == 5'd17);
    cover (t_near_o == 17'd5 && reached_by == 3'b001 && other[0] < product[0]);
  end

