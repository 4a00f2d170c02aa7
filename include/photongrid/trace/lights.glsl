// Lights, read from the scene buffer. Included by kernels after their scene buffer.
struct Light {
    uint form;
    bool is_area;             // a rectangle; other kinds have some of these members only
    vec3 position;            // of a rectangle light: one corner, m
    vec3 edge_u;              // m; x of a sphere: its radius
    vec3 edge_v;              // m
    vec3 normal;              // unit; light leaves on this side
    vec3 power;               // W
    float radiance_per_power; // of a rectangle, mesh or sphere: 1 / (pi area), m^-2 sr^-1
};

Light light_at(uint at)
{
    vec4 position_record = scene(at + 1u);
    Light l;
    l.form = uint(scene(at).x);
    l.is_area = l.form == RECTANGLE_LIGHT;
    l.position = vec3(position_record);
    l.edge_u = vec3(scene(at + 2u));
    l.edge_v = vec3(scene(at + 3u));
    l.normal = vec3(scene(at + 4u));
    l.power = vec3(scene(at + 5u));
    l.radiance_per_power = position_record.w;
    return l;
}

Light light_of(uint number)
{
    Table table = table_of(scene(LIGHT_TABLE));
    return light_at(table.first + table.stride * number);
}

// The scene's environment, its last light.
uint environment_light()
{
    Table table = table_of(scene(LIGHT_TABLE));
    return table.first + table.stride * (table.count - 1u);
}

// Probabilities, in proportion to power: that this light is chosen; that this light or one before it is.
float light_probability(uint at)
{
    return scene(at).y;
}
float cumulative_probability(uint at)
{
    return scene(at).z;
}
