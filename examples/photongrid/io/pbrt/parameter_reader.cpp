#include <photongrid/io/pbrt/parameter_reader.hpp>

#include <algorithm>

namespace photongrid::pbrt {

bool is_one_of(std::string_view word, std::initializer_list<std::string_view> words)
{
    return std::find(words.begin(), words.end(), word) != words.end();
}

namespace {
    void read_value(token_reader& t, parameter& p)
    {
        if (is_one_of(p.type, {"string", "texture"})) {
            p.texts.push_back(t.quoted("a text in quotes"));
        } else if (p.type == "bool") {
            const auto& next = t.peek();
            const bool is_value = next && (next->is == token::kind::word || next->is == token::kind::quoted)
                && (next->text == "true" || next->text == "false");
            if (!is_value)
                t.fail_at_next("true or false");
            p.truths.push_back(t.next()->text == "true");
        } else if (p.type == "spectrum" && t.peek() && t.peek()->is == token::kind::quoted) {
            p.texts.push_back(t.quoted(""));
        } else {
            p.numbers.push_back(t.number("a number"));
        }
    }
} // namespace

parameter read_parameter(token_reader& t)
{
    const auto place = t.place();
    const auto declared = t.quoted("a parameter: a text of its type and name");
    const auto begin = std::min(declared.find_first_not_of(" \t"), declared.size()),
               end = std::min(declared.find_first_of(" \t", begin), declared.size()),
               name = std::min(declared.find_first_not_of(" \t", end), declared.size()),
               past = std::min(declared.find_first_of(" \t", name), declared.size());
    parameter p{
        .type = declared.substr(begin, end - begin), .name = declared.substr(name, past - name), .place = place};
    if (p.name.empty())
        fail_at(place, "found the text " + shown_word(declared) + "; expected the type and name of a parameter");
    if (p.type == "color") // as in pbrt-v3
        p.type = "rgb";
    if (p.type == "xyz")
        fail_at(place,
            "found the type \"xyz\" of pbrt-v3, which pbrt-v4 does not have; `pbrt --upgrade` of pbrt-v4 rewrites the "
            "file");
    if (!is_one_of(p.type,
            {"float", "integer", "bool", "string", "texture", "point2", "vector2", "point3", "vector3", "point",
                "vector", "normal", "normal3", "rgb", "spectrum", "blackbody"}))
        fail_at(place, "found the type " + shown_word(p.type) + "; expected one of pbrt-v4, such as float");
    if (!t.peek() || t.peek()->is != token::kind::open) {
        read_value(t, p);
        return p;
    }
    const auto open = t.place();
    t.next();
    while (t.peek() && t.peek()->is != token::kind::close)
        read_value(t, p);
    if (!t.next())
        fail_at(open, "found [ without its ]");
    return p;
}

parameter_list read_parameters(token_reader& t)
{
    parameter_list all;
    while (t.peek() && t.peek()->is == token::kind::quoted)
        all.add(read_parameter(t));
    return all;
}

} // namespace photongrid::pbrt
