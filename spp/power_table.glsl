// Where a place of a slab lies in a table of P+ and P- over depth and thickness. Like spp_formulas.glsl, which comes
// before it, this text is C++ and GLSL.

SHARED_CONSTANT int kTableDepths = 64;       // nodes from the lit face to the other
SHARED_CONSTANT int kTableThicknesses = 48;  // nodes from no slab to one without end

struct TablePlace {
  int depth;          // node before the place                                   0 .. kTableDepths - 2
  int thickness;      //                                                         0 .. kTableThicknesses - 2
  Number depth_part;  // of the way to the next node                             [1], 0 .. 1
  Number thickness_part;
};

// (R27) Nodes stand evenly over w / (w + 4) and over A / (A + B), A^2 = z / (1 + z / 8), B^2 = r / (1 + r / 8), r = w - z:
// fine in thin slabs and at both faces, where light changes fast.
SHARED_FN TablePlace tablePlace(Number depth, Number thickness) {
  Number w = min(max(thickness, Number(0.0f)), Number(1.0e30f));
  Number z = depthWithin(depth, thickness, w);
  Number rest = w - z;
  Number above = sqrt(z / (Number(1.0f) + Number(0.125f) * z));
  Number below = sqrt(rest / (Number(1.0f) + Number(0.125f) * rest));
  Number along_depth = Number(kTableDepths - 1) * (above / max(above + below, Number(1.0e-30f)));
  Number along_thickness = Number(kTableThicknesses - 1) * (w / (w + Number(4.0f)));
  TablePlace place;
  place.depth = min(int(along_depth), kTableDepths - 2);
  place.thickness = min(int(along_thickness), kTableThicknesses - 2);
  place.depth_part = along_depth - Number(place.depth);
  place.thickness_part = along_thickness - Number(place.thickness);
  return place;
}

// Between the four nodes around a place: those of smaller thickness, then those of the next.
SHARED_FN Number tableValue(SHARED_IN(TablePlace) place, Number thin_before, Number thin_beyond, Number thick_before,
                            Number thick_beyond) {
  Number thin = thin_before + place.depth_part * (thin_beyond - thin_before);
  Number thick = thick_before + place.depth_part * (thick_beyond - thick_before);
  return thin + place.thickness_part * (thick - thin);
}
