// The weights of a triangle's corners at a point. Included by kernels.

// Twice the area of the triangle of p and an edge, negative where p is on the edge's other side.
float area_at_edge(vec3 p, vec3 from, vec3 to, vec3 n)
{
    precise vec3 edge = to - from;
    precise vec3 way = p - from;
    return dot3(cross3(edge, way), n);
}

// Twice the areas of the parts that p divides the triangle a, b, c into, each opposite to its corner.
vec3 triangle_weights(vec3 p, vec3 a, vec3 b, vec3 c, vec3 n)
{
    return vec3(area_at_edge(p, b, c, n), area_at_edge(p, c, a, n), area_at_edge(p, a, b, n));
}
