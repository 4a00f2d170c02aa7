// The phases of the search for the k-th nearest photon (kth_distance.glsl), in tally.w.
const uint COUNTING = 0u;   // scans count photons within eight pivots
const uint CLOSING_IN = 1u; // scans have one pivot and keep its neighbours
const uint FOUND = 2u;
