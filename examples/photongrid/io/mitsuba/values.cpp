#include <photongrid/io/import/token_reader.hpp>
#include <photongrid/io/mitsuba/values.hpp>
#include <photongrid/io/mitsuba/xml_values.hpp>

#include <algorithm>
#include <cmath>

namespace photongrid::mitsuba {

namespace {
    struct named_matter {
        std::string_view name;
        double index;
    };
    /// At about 589 nm, of solids and liquids at room temperature, of gases at 0 degrees and 1 atm (Hecht, Optics),
    /// with the names that Mitsuba has.
    constexpr named_matter matters[] = {{"vacuum", 1}, {"helium", 1.000036}, {"hydrogen", 1.000132}, {"air", 1.000277},
        {"carbon dioxide", 1.00045}, {"water", 1.333}, {"acetone", 1.36}, {"ethanol", 1.361},
        {"carbon tetrachloride", 1.461}, {"glycerol", 1.4729}, {"benzene", 1.501}, {"silicone oil", 1.52045},
        {"bromine", 1.661}, {"water ice", 1.31}, {"fused quartz", 1.458}, {"pyrex", 1.47}, {"acrylic glass", 1.49},
        {"polypropylene", 1.49}, {"bk7", 1.5046}, {"sodium chloride", 1.544}, {"amber", 1.55}, {"pet", 1.575},
        {"diamond", 2.419}};

    bool is_in_range(const dvec3& v) { return v.x >= 0 && v.y >= 0 && v.z >= 0 && v.x <= 1 && v.y <= 1 && v.z <= 1; }

    /// Planck's radiance, W/(m^2 sr nm), as Mitsuba has it.
    sampled_spectrum planck(double temperature)
    {
        constexpr double h = 6.62607015e-34, c = 299'792'458, k = 1.380649e-23;
        sampled_spectrum s;
        for (double nm = 380; nm <= 780; nm += 5) {
            const double metres = nm * 1e-9;
            s.wavelengths.push_back(nm);
            s.values.push_back(
                1e-9 * 2 * h * c * c / (std::pow(metres, 5) * std::expm1(h * c / (metres * k * temperature))));
        }
        return s;
    }
} // namespace

sampled_spectrum value_reader::spectrum(const property& p) const
{
    if (p.samples)
        return *p.samples;
    std::string text;
    try {
        text = builder_.files().bytes_of(p.text);
    } catch (const file_error& e) {
        fail_at(p.place, e.what());
    }
    token_reader t(std::make_shared<const std::string>(builder_.files().path_of(p.text)), text);
    std::vector<double> wavelengths, values;
    while (t.peek()) {
        wavelengths.push_back(t.number("a wavelength, nm"));
        values.push_back(t.number("a value"));
    }
    return samples_of(p.place, std::move(wavelengths), std::move(values));
}

/// A light's spectrum keeps its luminance, as in Mitsuba.
dvec3 value_reader::of_samples(const sampled_spectrum& s, meaning m) const
{
    return m == meaning::emission ? glm::max(rgb_of_tristimulus(tristimulus(s)), dvec3(0)) : reflected_rgb(s);
}

dvec3 value_reader::constant(const property& p, meaning m) const
{
    switch (p.is) {
    case property_kind::number:
    case property_kind::whole: return dvec3(p.numbers[0]);
    case property_kind::color: return {p.numbers[0], p.numbers[1], p.numbers[2]};
    case property_kind::spectrum: return of_samples(spectrum(p), m);
    case property_kind::blackbody: return of_samples(planck(p.numbers[0]), m) * p.numbers[1];
    default:
        fail_at(
            p.place, "found " + p.tag + " " + shown_word(p.name) + "; expected a float, rgb, a spectrum or a texture");
    }
}

std::optional<varying> value_reader::value(const object& o, std::string_view name, meaning m)
{
    if (const auto* p = o.find(name))
        return varying{constant(*p, m), {}};
    if (const auto* c = o.find_child(name))
        return texture(*c, m);
    return std::nullopt;
}

varying value_reader::reflectance(const object& o, std::string_view name, const dvec3& if_absent)
{
    auto v = value(o, name, meaning::reflectance).value_or(varying{if_absent, {}});
    if (!is_in_range(v.factor)) {
        builder_.note(o.place, o.said() + ": " + std::string(name) + " is limited to 0 to 1");
        v.factor = glm::clamp(v.factor, dvec3(0), dvec3(1));
    }
    return v;
}

varying value_reader::number(const object& o, std::string_view name, double if_absent)
{
    return value(o, name, meaning::number).value_or(varying{dvec3(if_absent), {}});
}

dvec3 value_reader::emission(const object& o, std::string_view name)
{
    const auto v = value(o, name, meaning::emission).value_or(varying{});
    if (v.texture.map)
        builder_.note(o.place, o.said() + ": a texture of " + std::string(name) + ": its mean is used");
    return mean_of(v);
}

double value_reader::index_of_refraction(const object& o, std::string_view name, const char* if_absent)
{
    const auto* p = o.find(name);
    std::string matter = if_absent;
    if (p != nullptr && p->is != property_kind::text) {
        if (p->is != property_kind::number && p->is != property_kind::whole)
            fail_at(p->place, "found " + p->tag + " " + shown_word(p->name) + "; expected a float or a string");
        return p->numbers[0];
    }
    if (p != nullptr)
        matter = p->text;
    for (const auto& known : matters)
        if (known.name.size() == matter.size()
            && std::equal(matter.begin(), matter.end(), known.name.begin(),
                [](char a, char b) { return (a >= 'A' && a <= 'Z' ? a + ('a' - 'A') : a) == b; }))
            return known.index;
    fail_at(p == nullptr ? o.place : p->place,
        "found " + shown_word(matter)
            + "; expected the name of a matter that Mitsuba knows, such as \"bk7\" or \"water\"");
}

dvec3 value_reader::bare_conductor(const object& o)
{
    const auto *eta = o.find("eta"), *k = o.find("k");
    // Mitsuba 0.6 takes copper where nothing is said, 3 a perfect mirror.
    auto name = o.text("material", eta == nullptr && o.is_old ? "Cu" : "none");
    if (eta == nullptr && k == nullptr) {
        if (name == "none")
            return dvec3(1);
        if (const auto known = metal_reflectance(std::string_view(name).substr(0, name.find('_')))) // "Cu_palik"
            return *known;
        builder_.note(o.place, o.said() + ": the metal " + shown_word(name) + ": a reflectance of 0.7 in its place");
        return dvec3(0.7);
    }
    const double outside = index_of_refraction(o, "ext_eta", "vacuum");
    if (!(outside > 0))
        fail_at(o.place, o.said() + ": \"ext_eta\" must be above 0");
    const auto samples = [&](const property* p, double if_absent) -> std::optional<sampled_spectrum> {
        if (p == nullptr)
            return sampled_spectrum{{500}, {if_absent}};
        if (p->is == property_kind::spectrum)
            return spectrum(*p);
        return std::nullopt;
    };
    const auto at_channel = [&](const property* p, double if_absent) {
        return p == nullptr ? dvec3(if_absent) : constant(*p, meaning::number);
    };
    const auto eta_at = samples(eta, 0), k_at = samples(k, 1);
    if ((eta != nullptr && eta_at) || (k != nullptr && k_at)) {
        if (!eta_at || !k_at)
            fail_at(o.place, o.said() + ": \"eta\" and \"k\" must both be spectra, or both rgb");
        sampled_spectrum made;
        for (double nm = 380; nm <= 780; nm += 5) {
            made.wavelengths.push_back(nm);
            made.values.push_back(conductor_reflectance(eta_at->at(nm) / outside, k_at->at(nm) / outside));
        }
        return reflected_rgb(made);
    }
    const auto n = at_channel(eta, 0), absorption = at_channel(k, 1);
    dvec3 made;
    for (int c = 0; c < 3; ++c)
        made[c] = conductor_reflectance(n[c] / outside, absorption[c] / outside);
    return made;
}

varying value_reader::conductor(const object& o)
{
    auto v = reflectance(o, "specular_reflectance", dvec3(1));
    v.factor *= bare_conductor(o);
    return v;
}

} // namespace photongrid::mitsuba
