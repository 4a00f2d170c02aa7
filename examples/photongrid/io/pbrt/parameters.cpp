#include <photongrid/io/pbrt/description.hpp>
#include <photongrid/io/whole_file.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace photongrid::pbrt {

namespace {
    std::string said(const parameter& p) { return "\"" + printable(p.type + " " + p.name, 80) + "\""; }

    [[noreturn]] void wrong(const parameter& p, const std::string& expected)
    {
        fail_at(p.place, "found " + said(p) + "; expected " + expected);
    }
} // namespace

const rgb_primaries* color_space(std::string_view name)
{
    struct named_space {
        std::string_view name;
        rgb_primaries colors;
    };
    static const named_space spaces[] = {{"srgb", {{{{0.64, 0.33}, {0.30, 0.60}, {0.15, 0.06}}}, {0.3127, 0.3290}}},
        {"dci-p3", {{{{0.680, 0.320}, {0.265, 0.690}, {0.150, 0.060}}}, {0.3127, 0.3290}}},
        {"rec2020", {{{{0.708, 0.292}, {0.170, 0.797}, {0.131, 0.046}}}, {0.3127, 0.3290}}},
        {"aces2065-1", {{{{0.7347, 0.2653}, {0, 1}, {0.0001, -0.077}}}, {0.32168, 0.33767}}}};
    for (const auto& s : spaces)
        if (s.name == name)
            return &s.colors;
    return nullptr;
}

void parameter_list::add_absent(const parameter_list& defaults)
{
    for (const auto& p : defaults.all_)
        if (std::none_of(all_.begin(), all_.end(), [&](const parameter& q) { return q.name == p.name; }))
            all_.push_back(p);
}

const parameter* parameter_list::find(std::string_view name) const
{
    const auto found = std::find_if(all_.begin(), all_.end(), [&](const parameter& p) { return p.name == name; });
    if (found == all_.end())
        return nullptr;
    found->used = true;
    return &*found;
}

parameter* parameter_list::change(std::string_view name)
{
    const auto found = std::find_if(all_.begin(), all_.end(), [&](const parameter& p) { return p.name == name; });
    return found == all_.end() ? nullptr : &*found;
}

std::optional<double> parameter_list::number(std::string_view name) const
{
    const auto* p = find(name);
    if (p == nullptr)
        return std::nullopt;
    if ((p->type != "float" && p->type != "integer") || p->numbers.size() != 1)
        wrong(*p, "one float");
    return p->numbers[0];
}

double parameter_list::number(std::string_view name, double if_absent) const
{
    return number(name).value_or(if_absent);
}

int parameter_list::whole(std::string_view name, int if_absent) const
{
    const auto* p = find(name);
    if (p == nullptr)
        return if_absent;
    if (p->type != "integer" || p->numbers.size() != 1 || p->numbers[0] != std::floor(p->numbers[0])
        || std::abs(p->numbers[0]) > std::numeric_limits<int>::max())
        wrong(*p, "one integer");
    return static_cast<int>(p->numbers[0]);
}

bool parameter_list::truth(std::string_view name, bool if_absent) const
{
    const auto* p = find(name);
    if (p == nullptr)
        return if_absent;
    if (p->type != "bool" || p->truths.size() != 1)
        wrong(*p, "one bool");
    return p->truths[0];
}

std::string parameter_list::text(std::string_view name, const std::string& if_absent) const
{
    const auto* p = find(name);
    if (p == nullptr)
        return if_absent;
    if ((p->type != "string" && p->type != "texture") || p->texts.size() != 1)
        wrong(*p, "one text");
    return p->texts[0];
}

std::vector<double> parameter_list::numbers(
    std::string_view name, std::initializer_list<std::string_view> types, std::size_t together) const
{
    const auto* p = find(name);
    if (p == nullptr)
        return {};
    if (std::find(types.begin(), types.end(), p->type) == types.end())
        wrong(*p, "the type \"" + std::string(*types.begin()) + "\"");
    if (p->numbers.size() % together != 0)
        wrong(*p, "a multiple of " + std::to_string(together) + " numbers");
    return p->numbers;
}

std::optional<dvec3> parameter_list::point(std::string_view name) const
{
    const auto all = numbers(name, {"point3", "point", "vector3", "vector"}, 3);
    if (all.empty())
        return std::nullopt;
    return dvec3(all[0], all[1], all[2]);
}

void parameter_list::note_unused(import_log& log, const std::string& of) const
{
    for (const auto& p : all_)
        if (!p.used)
            log.add(p.place, of + ": " + said(p) + " is left out");
}

} // namespace photongrid::pbrt
