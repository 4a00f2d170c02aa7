// Included by kernels after their INPUT instances (trace/instance.glsl).

// The last of `count` instances that begins at most at this number, by one of its records.
uint find_instance(uint count, uint record, uint number)
{
    uint low = 0u;
    uint high = count - 1u;
    while (low < high) {
        uint middle = (low + high + 1u) / 2u;
        bool begins = instances(INSTANCE_RECORDS * middle + record).w <= number;
        low = begins ? middle : low;
        high = begins ? high : middle - 1u;
    }
    return low;
}

// A vector by the matrix in three records.
vec3 by_matrix(uint at, vec3 v)
{
    return vec3(dot3(corner_of(instances(at)), v), dot3(corner_of(instances(at + 1u)), v),
        dot3(corner_of(instances(at + 2u)), v));
}
