#include <photongrid/io/gltf/document.hpp>

#include <cmath>

namespace photongrid::gltf {

namespace {
    std::string range_text(double low, double high)
    {
        const auto text = [](double v) {
            auto t = std::to_string(v);
            t.erase(t.find_last_not_of('0') + 1);
            return t.ends_with('.') ? t.substr(0, t.size() - 1) : t;
        };
        return low > -1e18 && high < 1e18 ? " from " + text(low) + " to " + text(high)
            : low > -1e18                 ? " of " + text(low) + " or more"
                                          : " below 10^18";
    }
} // namespace

source_place part::place() const { return all_->place_of(value_->place); }

const json_value* part::find(std::string_view key, json_kind kind, const char* expected) const
{
    const auto* v = value_->find(key);
    if (v != nullptr && v->kind != kind)
        part(*all_, *v).fail(
            '"' + std::string(key) + "\": found " + photongrid::described(*v) + "; expected " + expected);
    return v;
}

std::optional<part> part::object(std::string_view key) const
{
    const auto* v = find(key, json_kind::object, "an object");
    return v == nullptr ? std::nullopt : std::optional(part(*all_, *v));
}

std::vector<part> part::items(std::string_view key) const
{
    std::vector<part> all;
    if (const auto* v = find(key, json_kind::array, "an array")) {
        all.reserve(v->items.size());
        for (const auto& i : v->items)
            all.emplace_back(*all_, i);
    }
    return all;
}

double part::as_number(double low, double high) const
{
    if (value_->kind != json_kind::number || !(value_->number >= low && value_->number <= high))
        fail("found " + described() + "; expected a number" + range_text(low, high));
    return value_->number;
}

double part::number(std::string_view key, double if_absent, double low, double high) const
{
    const auto* v = find(key, json_kind::number, "a number");
    if (v == nullptr)
        return if_absent;
    if (!(v->number >= low && v->number <= high))
        part(*all_, *v).fail('"' + std::string(key) + "\": found " + photongrid::described(*v) + "; expected a number"
            + range_text(low, high));
    return v->number;
}

std::optional<std::size_t> part::whole(std::string_view key, std::size_t most) const
{
    const auto* v = find(key, json_kind::number, "a whole number");
    if (v == nullptr)
        return std::nullopt;
    if (!(v->number >= 0 && v->number <= static_cast<double>(most)) || v->number != std::floor(v->number))
        part(*all_, *v).fail('"' + std::string(key) + "\": found " + photongrid::described(*v)
            + "; expected a whole number from 0 to " + std::to_string(most));
    return static_cast<std::size_t>(v->number);
}

std::size_t part::as_index(const char* list) const
{
    const auto count = all_->count(list);
    if (value_->kind != json_kind::number || !(value_->number >= 0 && value_->number < static_cast<double>(count))
        || value_->number != std::floor(value_->number))
        fail("found " + described() + "; expected an index of \"" + list + "\", of which there are "
            + std::to_string(count));
    return static_cast<std::size_t>(value_->number);
}

std::optional<std::size_t> part::index(std::string_view key, const char* list) const
{
    const auto* v = value_->find(key);
    return v == nullptr ? std::nullopt : std::optional(part(*all_, *v).as_index(list));
}

std::string part::as_text() const
{
    if (value_->kind != json_kind::string)
        fail("found " + described() + "; expected a text");
    return value_->text;
}

std::optional<std::string> part::text(std::string_view key) const
{
    const auto* v = find(key, json_kind::string, "a text");
    return v == nullptr ? std::nullopt : std::optional(v->text);
}

bool part::truth(std::string_view key, bool if_absent) const
{
    const auto* v = find(key, json_kind::boolean, "true or false");
    return v == nullptr ? if_absent : v->truth;
}

void part::numbers_into(std::string_view key, double low, double high, double* to, std::size_t count) const
{
    const auto* v = find(key, json_kind::array, "an array");
    if (v->items.size() != count)
        part(*all_, *v).fail('"' + std::string(key) + "\": found " + photongrid::described(*v) + "; expected "
            + std::to_string(count) + " numbers");
    for (const auto& i : v->items)
        *to++ = part(*all_, i).as_number(low, high);
}

std::optional<dvec3> part::colour(std::string_view key, double most) const
{
    const auto c = numbers<3>(key, 0, most);
    return c ? std::optional(dvec3((*c)[0], (*c)[1], (*c)[2])) : std::nullopt;
}

std::optional<part> part::extension(std::string_view name) const
{
    const auto all = object("extensions");
    return all ? all->object(name) : std::nullopt;
}

std::vector<std::string> part::keys() const
{
    std::vector<std::string> all;
    for (const auto& i : value_->items)
        all.push_back(i.key);
    return all;
}

} // namespace photongrid::gltf
