// The phases of a search for the last id at a radius (kth_tie.glsl).
const uint FIRST_AND_LAST = 0u; // finding the smallest and the largest id
const uint COUNTING_IDS = 1u;
const uint FOUND_ID = 2u;
