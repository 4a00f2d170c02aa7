// Disks. Records: plane; center, radius; material.
SWITCH(2, DISKS)
const uint DISK = 2u;

float hit_disk(uint at, vec3 o, vec3 d, float far)
{
    float t = hit_plane(scene(at), o, d, far);
    if (!(t < far))
        return far;
    vec4 center = scene(at + 1u);
    precise vec3 f = ray_at(o, d, t) - vec3(center);
    return dot3(f, f) <= center.w * center.w ? t : far;
}

Closest closest_disk(vec3 o, vec3 d, Closest c)
{
    Table disks = table_of(scene(DISK));
    uint at = disks.first;
    for (uint n = 0u; n < disks.count; ++n) {
        float t = hit_disk(at, o, d, c.t);
        if (t < c.t) {
            c.t = t;
            c.kind = DISK;
            c.at = at;
        }
        at += disks.stride;
    }
    return c;
}

Hit disk_surface(uint at, Hit hit)
{
    hit.position = onto_plane(scene(at), hit.position);
    hit.normal = vec3(scene(at));
    hit.material = uint(scene(at + 2u).x);
    return hit;
}

bool disks_block(vec3 o, vec3 d, float far)
{
    Table disks = table_of(scene(DISK));
    uint at = disks.first;
    for (uint n = 0u; n < disks.count; ++n) {
        if (hit_disk(at, o, d, far) < far)
            return true;
        at += disks.stride;
    }
    return false;
}
