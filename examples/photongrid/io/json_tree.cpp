#include <photongrid/io/json_tree.hpp>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <set>

namespace photongrid {

namespace {
    /// Quotes text for a message: shortened, and without control characters.
    std::string in_quotes(std::string_view s)
    {
        std::string out = "\"";
        for (const char c : s.substr(0, 60))
            out += static_cast<unsigned char>(c) < 0x20 || c == 0x7F ? '?' : c;
        return out + (s.size() > 60 ? "…\"" : "\"");
    }
} // namespace

// nlohmann's parser calls one of these functions for each token, in the order of the file, without the token's
// position. `token` finds it: the text so far is valid JSON, so the next token begins after blanks, commas and colons.
class json_builder {
public:
    explicit json_builder(json_tree& tree) : tree_(tree)
    {
        if (std::string_view(tree.text_).starts_with("\xEF\xBB\xBF"))
            cursor_ = 3;
    }

    bool null() { return put({.kind = json_kind::null, .place = token()}); }
    bool boolean(bool b) { return put({.kind = json_kind::boolean, .place = token(), .truth = b}); }
    bool number_integer(std::int64_t i) { return number(static_cast<double>(i)); }
    bool number_unsigned(std::uint64_t u) { return number(static_cast<double>(u)); }
    bool number_float(double d, const std::string&) { return number(d); }
    bool string(std::string& s)
    {
        const auto place = token();
        return put({.kind = json_kind::string, .place = place, .text = std::move(s)});
    }
    bool binary(const std::vector<std::uint8_t>&) { return false; }
    bool start_object(std::size_t) { return open(json_kind::object); }
    bool end_object() { return close(); }
    bool start_array(std::size_t) { return open(json_kind::array); }
    bool end_array() { return close(); }

    bool key(std::string& k)
    {
        auto& f = frames_.back();
        f.key_place = token();
        if (!f.keys.insert(k).second)
            tree_.fail(f.key_place, "key " + in_quotes(k) + " is given twice; expected each key once");
        f.key = std::move(k);
        return true;
    }

    // `position` counts the characters read. The error is at the token after the last accepted one, except for commas
    // and colons; inside a string it is at the last character read.
    bool parse_error(std::size_t position, const std::string& last_token, const nlohmann::json::exception& e)
    {
        const auto& t = tree_.text_;
        const std::size_t last = position > t.size() || position == 0 ? t.size() : position - 1;
        const bool in_string = std::string_view(e.what()).find("invalid string") != std::string_view::npos;
        const std::size_t place = in_string ? last : std::min(last, t.find_first_not_of(" \t\r\n,:", cursor_));
        if (e.id == 406)
            tree_.fail(place,
                "number " + last_token.substr(0, 60)
                    + " is out of range; expected a number that double precision holds");
        std::string what = e.what();
        // "[json.exception.parse_error.101] parse error at line 1, column 2: syntax error while parsing …": the first
        // two parts repeat the position.
        if (const auto at = what.find("column "); at != std::string::npos)
            if (const auto colon = what.find(": ", at); colon != std::string::npos)
                what.erase(0, colon + 2);
        // Leave out the text of the file that follows, by its length: it may contain anything, even these words.
        constexpr std::string_view last_read = "; last read: '";
        if (const auto at = what.find(last_read); at != std::string::npos)
            what.erase(at, last_read.size() + last_token.size() + 1);
        // After a value a comma may follow too; the parser names the other token alone.
        for (const std::string_view end : {"expected '}'", "expected ']'"})
            if (what.ends_with(end))
                what.insert(what.size() - 3, "',' or ");
        tree_.fail(place, what.substr(0, 300));
    }

private:
    struct frame {
        json_value value;
        std::set<std::string> keys{};
        std::string key{};
        std::size_t key_place = 0;
    };

    bool number(double d)
    {
        const auto place = token();
        return put({.kind = json_kind::number,
            .place = place,
            .number = d,
            .text = tree_.text_.substr(place, cursor_ - place)});
    }

    std::size_t token()
    {
        const auto& t = tree_.text_;
        cursor_ = std::min(t.find_first_not_of(" \t\r\n,:", cursor_), t.size());
        const auto place = cursor_;
        if (place == t.size())
            return place;
        if (t[place] == '"')
            for (++cursor_; cursor_ < t.size() && t[cursor_] != '"'; ++cursor_)
                cursor_ += t[cursor_] == '\\' ? 1u : 0u;
        else if (t[place] != '{' && t[place] != '[' && t[place] != '}' && t[place] != ']') {
            cursor_ = std::min(t.find_first_of(" \t\r\n,:]}", cursor_), t.size());
            return place;
        }
        cursor_ = std::min(cursor_ + 1, t.size());
        return place;
    }

    bool open(json_kind kind)
    {
        const auto place = token();
        if (frames_.size() == tree_.limits_.depth)
            tree_.fail(place,
                "nested deeper than " + std::to_string(tree_.limits_.depth) + " levels; a scene needs far fewer");
        count(place);
        frames_.push_back({.value = {.kind = kind, .place = place}});
        return true;
    }

    bool close()
    {
        token();
        json_value done = std::move(frames_.back().value);
        done.end = cursor_;
        frames_.pop_back();
        return place_value(std::move(done));
    }

    bool put(json_value v)
    {
        count(v.place);
        v.end = cursor_;
        return place_value(std::move(v));
    }

    bool place_value(json_value v)
    {
        if (frames_.empty())
            tree_.root_ = std::move(v);
        else {
            auto& f = frames_.back();
            if (f.value.kind == json_kind::object) {
                v.key = std::move(f.key);
                v.key_place = f.key_place;
            }
            f.value.items.push_back(std::move(v));
        }
        return true;
    }

    void count(std::size_t place)
    {
        if (++values_ > tree_.limits_.values)
            tree_.fail(
                place, "more than " + std::to_string(tree_.limits_.values) + " values; expected a scene, not a mesh");
    }

    json_tree& tree_;
    std::vector<frame> frames_;
    std::size_t cursor_ = 0, values_ = 0;
};

const json_value* json_value::find(std::string_view key_wanted) const
{
    const auto m = std::find_if(items.begin(), items.end(), [&](const json_value& x) { return x.key == key_wanted; });
    return m == items.end() ? nullptr : &*m;
}

json_tree::json_tree(std::string file, std::string text, const json_limits& limits)
    : file_(std::move(file)), text_(std::move(text)), limits_(limits)
{
    if (text_.size() > limits_.bytes)
        throw scene_error(
            file_, 0, 0, "larger than " + std::to_string(limits_.bytes >> 20) + " MiB; expected a scene file");
    json_builder builder(*this);
    nlohmann::json::sax_parse(text_.data(), text_.data() + text_.size(), &builder);
}

void json_tree::fail(std::size_t place, const std::string& what) const
{
    const auto before = std::string_view(text_).substr(0, place);
    const auto line = static_cast<std::size_t>(std::count(before.begin(), before.end(), '\n')) + 1;
    auto begin = before.rfind('\n');
    begin = begin == std::string_view::npos ? 0 : begin + 1;
    // Bytes 10xxxxxx continue a UTF-8 character.
    const auto column = std::count_if(before.begin() + static_cast<std::ptrdiff_t>(begin), before.end(),
        [](char c) { return (static_cast<unsigned char>(c) & 0xC0u) != 0x80u; });
    throw scene_error(file_, line, static_cast<std::size_t>(column) + 1, what);
}

std::string described(const json_value& v)
{
    switch (v.kind) {
    case json_kind::null: return "null";
    case json_kind::boolean: return v.truth ? "true" : "false";
    case json_kind::number: return "the number " + v.text.substr(0, 60);
    case json_kind::string: return "the text " + in_quotes(v.text);
    case json_kind::array: return "an array of " + std::to_string(v.items.size());
    case json_kind::object: return "an object";
    }
    return "nothing";
}

std::string nearest(std::string_view word, const std::vector<std::string>& candidates)
{
    std::string best;
    // Up to a third of the letters may differ.
    std::size_t best_distance = std::min<std::size_t>(word.size(), 60) / 3 + 2;
    if (word.size() > 60)
        return best;
    for (const auto& c : candidates) {
        std::vector<std::size_t> row(c.size() + 1); // Levenshtein's distance, row by row
        for (std::size_t j = 0; j < row.size(); ++j)
            row[j] = j;
        for (std::size_t i = 0; i < word.size(); ++i) {
            std::size_t diagonal = row[0];
            row[0] = i + 1;
            for (std::size_t j = 0; j < c.size(); ++j) {
                const std::size_t above = row[j + 1];
                row[j + 1] = std::min({above + 1, row[j] + 1, diagonal + (word[i] == c[j] ? 0u : 1u)});
                diagonal = above;
            }
        }
        if (row.back() < best_distance) {
            best_distance = row.back();
            best = c;
        }
    }
    return best;
}

std::string read_scene_text(const std::string& path)
{
    const auto refuse = [&](const char* what) -> scene_error {
        return {path, 0, 0, std::string("the file cannot be read: ") + what};
    };
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(
        std::fopen(path.c_str(), "rb"), [](std::FILE* f) { return f ? std::fclose(f) : 0; });
    if (!file)
        throw refuse(std::strerror(errno));
    std::string text;
    std::vector<char> block(std::size_t{1} << 16);
    while (const auto n = std::fread(block.data(), 1, block.size(), file.get())) {
        text.append(block.data(), n);
        if (text.size() > json_limits{}.bytes)
            throw scene_error(
                path, 0, 0, "larger than " + std::to_string(json_limits{}.bytes >> 20) + " MiB; expected a scene file");
    }
    if (std::ferror(file.get()))
        throw refuse(std::strerror(errno));
    return text;
}

} // namespace photongrid
