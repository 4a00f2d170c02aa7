// The power of a photon that was kept, with its share of the power of those without a slot (2.2.2).
#ifndef PHOTONGRID_INSIDE_KERNEL_STRUCT // core/begin.hpp

inline vec4 redistributed(vec4 arrived, vec4 scale, vec4 surplus)
{
    precise vec4 p = vec4(arrived.x * scale.x + surplus.x, arrived.y * scale.y + surplus.y,
        arrived.z * scale.z + surplus.z, arrived.w);
    return p;
}

#endif
