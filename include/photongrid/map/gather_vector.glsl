// Gathers one attribute into map order: values[list[i]], or 0 for an empty entry.
struct Params {
    uint photons; // ids are below this
};
PARAMS(Params)
INPUT(0, uint, list)
INPUT(1, vec4, values)
OUTPUT(0, vec4, value)

void kernel(uint i)
{
    uint photon = list(i);
    value = vec4(0.0f, 0.0f, 0.0f, 0.0f);
    if (photon < args.photons)
        value = values(photon);
}
