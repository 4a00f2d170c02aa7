#include <photongrid/io/import/coat.hpp>
#include <photongrid/trace/coat_layout.hpp>

#include <memory>

namespace photongrid {

void set_reflectance_below_coat(material& plastic)
{
    const double thrown_back
        = detail::shares_of_coat(plastic.index_of_refraction, plastic.roughness * plastic.roughness).thrown_back;
    // Of b, the reflectance below, b (1 - t) / (1 - b t) leaves (trace/coat.glsl).
    const auto below = [&](const dvec3& leaves) { return leaves / (1 - thrown_back + thrown_back * leaves); };
    if (plastic.texture.map) {
        auto map = *plastic.texture.map;
        for (auto& t : map.texels) {
            const auto colour = below(plastic.reflectance * dvec3(t) / 65535.0) * 65535.0 + 0.5;
            t = glm::u16vec4(colour.x, colour.y, colour.z, t.w);
        }
        plastic.texture.map = std::make_shared<const texture>(std::move(map));
        plastic.texture.file.clear(); // it is not what the file has any more
        plastic.reflectance = dvec3(1);
    } else {
        plastic.reflectance = below(plastic.reflectance);
    }
}

} // namespace photongrid
