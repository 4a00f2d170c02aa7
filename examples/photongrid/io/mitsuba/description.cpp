#include <photongrid/io/mitsuba/description.hpp>
#include <photongrid/io/whole_file.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace photongrid::mitsuba {

namespace {
    std::string said_of(const property& p) { return p.tag + " " + shown_word(p.name); }

    [[noreturn]] void wrong(const property& p, const std::string& expected)
    {
        fail_at(p.place, "found " + said_of(p) + "; expected " + expected);
    }
} // namespace

const property* object::find(std::string_view name) const
{
    const auto found
        = std::find_if(properties.begin(), properties.end(), [&](const property& p) { return p.name == name; });
    if (found == properties.end())
        return nullptr;
    found->used = true;
    return &*found;
}

std::optional<double> object::number(std::string_view name) const
{
    const auto* p = find(name);
    if (p == nullptr)
        return std::nullopt;
    if (p->is != property_kind::number && p->is != property_kind::whole)
        wrong(*p, "a float");
    return p->numbers[0];
}

double object::number(std::string_view name, double if_absent) const { return number(name).value_or(if_absent); }

int object::whole(std::string_view name, int if_absent) const
{
    const auto* p = find(name);
    if (p == nullptr)
        return if_absent;
    if (p->is != property_kind::whole)
        wrong(*p, "an integer");
    return static_cast<int>(p->numbers[0]);
}

bool object::truth(std::string_view name, bool if_absent) const
{
    const auto* p = find(name);
    if (p == nullptr)
        return if_absent;
    if (p->is != property_kind::truth)
        wrong(*p, "a boolean");
    return p->truth;
}

std::string object::text(std::string_view name, const std::string& if_absent) const
{
    const auto* p = find(name);
    if (p == nullptr)
        return if_absent;
    if (p->is != property_kind::text)
        wrong(*p, "a string");
    return p->text;
}

std::optional<dvec3> object::vector(std::string_view name) const
{
    const auto* p = find(name);
    if (p == nullptr)
        return std::nullopt;
    if (p->is != property_kind::vector)
        wrong(*p, "a point or a vector");
    return dvec3(p->numbers[0], p->numbers[1], p->numbers[2]);
}

glm::dmat4 object::transform(std::string_view name) const
{
    const auto* p = find(name);
    if (p == nullptr)
        return glm::dmat4(1);
    if (p->is != property_kind::transform)
        wrong(*p, "a transform");
    return p->matrix;
}

const child* object::find_child(std::string_view name) const
{
    const auto found = std::find_if(children.begin(), children.end(), [&](const child& c) { return c.name == name; });
    if (found == children.end())
        return nullptr;
    found->used = true;
    return &*found;
}

std::vector<const child*> object::all_of(std::string_view tag_of_children) const
{
    std::vector<const child*> all;
    for (const auto& c : children)
        if (c.target->tag == tag_of_children) {
            c.used = true;
            all.push_back(&c);
        }
    return all;
}

std::string object::said() const { return type.empty() ? tag : tag + " " + shown_word(type); }

void object::note_unused(import_log& log) const
{
    for (const auto& p : properties)
        if (!p.used)
            log.add(p.place, said() + ": " + said_of(p) + " is left out");
    for (const auto& c : children)
        if (!c.used)
            log.add(c.place,
                said() + ": " + (c.name.empty() ? "" : shown_word(c.name) + ", a ") + c.target->said()
                    + (c.name.empty() ? "" : ",") + " is left out");
}

} // namespace photongrid::mitsuba
