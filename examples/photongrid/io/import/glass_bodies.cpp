#include <photongrid/io/import/glass_bodies.hpp>
#include <photongrid/io/whole_file.hpp>
#include <photongrid/reference/intersect.hpp>

#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <numeric>
#include <optional>
#include <tuple>

namespace photongrid {

namespace {
    /// A side of a triangle, from one welded vertex to another.
    struct side {
        std::uint32_t low, high;     ///< welded vertices
        bool forward;                ///< from low to high
        std::uint32_t triangle, nth; ///< the side from corner nth to the next
    };

    /// The number of each vertex among those at different places.
    std::vector<std::uint32_t> welded(const mesh& m)
    {
        const auto place = [&](std::uint32_t v) {
            const auto& p = m.positions[v];
            return std::tuple(p.x, p.y, p.z);
        };
        std::vector<std::uint32_t> order(m.positions.size()), number(m.positions.size());
        std::iota(order.begin(), order.end(), 0u);
        std::sort(order.begin(), order.end(), [&](auto a, auto b) { return place(a) < place(b); });
        for (std::size_t i = 0, n = 0; i < order.size(); ++i) {
            if (i > 0 && place(order[i]) != place(order[i - 1]))
                n = i;
            number[order[i]] = static_cast<std::uint32_t>(n);
        }
        return number;
    }

    /// The sides without a partner that is wound against them.
    std::vector<side> open_sides(const mesh& m)
    {
        const auto number = welded(m);
        std::vector<side> all, open;
        for (std::uint32_t t = 0; t < m.triangles.size(); ++t)
            for (std::uint32_t n = 0; n < 3; ++n) {
                const auto a = number[m.triangles[t][static_cast<int>(n)]],
                           b = number[m.triangles[t][static_cast<int>((n + 1) % 3)]];
                if (a != b)
                    all.push_back({std::min(a, b), std::max(a, b), a < b, t, n});
            }
        const auto edge = [](const side& s) { return std::tuple(s.low, s.high, s.forward, s.triangle); };
        std::sort(all.begin(), all.end(), [&](const side& a, const side& b) { return edge(a) < edge(b); });
        for (auto first = all.begin(); first != all.end();) {
            const auto past = std::find_if(
                first, all.end(), [&](const side& s) { return s.low != first->low || s.high != first->high; });
            const auto turn = std::find_if(first, past, [](const side& s) { return s.forward; });
            const auto backward = turn - first, forward = past - turn;
            if (backward > forward)
                open.insert(open.end(), first + forward, turn);
            else
                open.insert(open.end(), turn + backward, past);
            first = past;
        }
        return open;
    }

    /// Whether shapes hold most of the open edges of a mesh: they are met within a fiftieth of its size.
    bool is_held(const reference::geometry& shapes, const placed_mesh& m, const std::vector<side>& open)
    {
        const double reach = 0.02 * shape_kind<placed_mesh>::size(m);
        constexpr std::size_t most = 256;
        const std::size_t step = (open.size() + most - 1) / most;
        std::size_t held = 0, tried = 0;
        for (std::size_t i = 0; i < open.size(); i += step) {
            const auto c = corners_of(*m.surface, open[i].triangle);
            const auto at = [&](std::uint32_t n) { return place_of(m, c[(open[i].nth + n) % 3]); };
            const dvec3 inside = (at(0) + at(1) + at(2)) / 3.0, edge = 0.5 * (at(0) + at(1)),
                        out = glm::normalize(edge - inside), start = edge - 0.5 * reach * out;
            if (!detail::finite(out))
                continue;
            ++tried;
            // Start beside the sheet on both sides, so that the sheet itself is not met.
            const dvec3 normal = glm::normalize(glm::cross(at(1) - at(0), at(2) - at(0)));
            bool met = false;
            for (const double up : {1e-3, -1e-3})
                met = met || shapes.nearest({start + up * reach * normal, out, reference::nothing}).t < 1.5 * reach;
            held += met ? 1 : 0;
        }
        return 2 * held > tried;
    }

    std::shared_ptr<const mesh> turned(const mesh& m)
    {
        auto made = m;
        for (auto& t : made.triangles)
            std::swap(t.y, t.z);
        for (auto& n : made.normals)
            n = -n;
        return std::make_shared<const mesh>(std::move(made));
    }

    /// Works on the meshes of a scene.
    class mender {
    public:
        mender(imported_scene& s, const std::string& file, bool as_it_is)
            : scene_(s.scene), notes_(s.notes), file_(file), as_it_is_(as_it_is)
        {
        }

        void mend(std::size_t i)
        {
            auto& m = scene_.meshes[i];
            const auto [known, is_new] = closures_.emplace(m.surface, mesh_closure{});
            if (is_new)
                known->second = closure_of(*m.surface);
            const auto& closure = known->second;
            if (closure.open_share > 0.01)
                mend_open(i);
            else if (closure.open_edges > 0)
                say(i, "has " + std::to_string(closure.open_edges) + " open edges; light goes astray at its holes");
            else if (closure.open_edges == 0 && closure.volume < 0 && !is_cavity(i))
                turn(i);
        }

    private:
        /// All shapes, built once and only if a mesh is open: turning others and panes leave them where they are.
        const reference::geometry& shapes()
        {
            if (!shapes_)
                shapes_.emplace(scene_);
            return *shapes_;
        }

        /// Whether the mesh may be the inner wall of hollow glass.
        bool is_cavity(std::size_t i) const
        {
            const auto box = box_of(scene_.meshes[i]);
            for (std::size_t n = 0; n < scene_.meshes.size(); ++n) {
                const auto& other = scene_.meshes[n];
                if (n == i || !refracts(scene_.materials, scene_.materials[other.material]))
                    continue;
                const auto outer = box_of(other);
                if (glm::all(glm::lessThan(outer.low, box.low)) && glm::all(glm::greaterThan(outer.high, box.high)))
                    return true;
            }
            return false;
        }

        static bounds box_of(const placed_mesh& m)
        {
            bounds b;
            shape_kind<placed_mesh>::add_bounds(b, m);
            return b;
        }

        void turn(std::size_t i)
        {
            auto& m = scene_.meshes[i];
            if (as_it_is_) {
                say(i, "is inside out: the air is inside of it");
                return;
            }
            say(i, "is inside out; its triangles are turned");
            auto& made = turned_[m.surface];
            if (!made)
                made = turned(*m.surface);
            m.surface = made;
            m.file.clear();
        }

        void mend_open(std::size_t i)
        {
            auto& m = scene_.meshes[i];
            if (as_it_is_ || is_held(shapes(), m, open_sides(*m.surface)))
                say(i,
                    "is open: it is drawn as the face of a body that goes on behind it, as water in a pool; "
                    "for a pane use thin glass");
            else {
                say(i, "is open; it is drawn as a pane of thin glass. Close it to make it a body");
                m.material = as_pane(m.material);
            }
        }

        std::uint32_t as_pane(std::uint32_t material)
        {
            const auto [found, is_new] = panes_.emplace(material, 0);
            if (is_new) {
                auto pane = scene_.materials[material];
                if (is_mixture(pane))
                    for (auto& part : pane.parts)
                        part = refracts(scene_.materials[part]) ? as_pane(part) : part;
                else
                    pane.kind = material_kind::thin_glass;
                pane.name = unused_name(pane.name + " (pane)");
                found->second = static_cast<std::uint32_t>(scene_.materials.size());
                scene_.materials.push_back(std::move(pane));
            }
            return found->second;
        }

        std::string unused_name(std::string name) const
        {
            while (std::any_of(
                scene_.materials.begin(), scene_.materials.end(), [&](const material& m) { return m.name == name; }))
                name += "'";
            return name;
        }

        void say(std::size_t i, const std::string& what)
        {
            const auto& m = scene_.meshes[i];
            const auto& name = scene_.materials[m.material].name;
            if (notes_.size() < 1000)
                notes_.push_back({file_, 0, 0,
                    "meshes[" + std::to_string(i) + "]" + (m.file.empty() ? "" : " (" + m.file + ")") + " of glass "
                        + shown_word(name) + " " + what});
        }

        photongrid::scene& scene_;
        std::vector<import_note>& notes_;
        const std::string& file_;
        bool as_it_is_;
        std::optional<reference::geometry> shapes_;
        std::map<std::shared_ptr<const mesh>, mesh_closure> closures_;
        std::map<std::shared_ptr<const mesh>, std::shared_ptr<const mesh>> turned_;
        std::map<std::uint32_t, std::uint32_t> panes_;
    };
} // namespace

mesh_closure closure_of(const mesh& m)
{
    mesh_closure made;
    made.open_edges = open_sides(m).size();
    dvec3 sum(0);
    double area = 0;
    const dvec3 middle = m.triangles.empty() ? dvec3(0) : dvec3(corners_of(m, 0)[0]);
    for (std::size_t t = 0; t < m.triangles.size(); ++t) {
        const auto corners = corners_of(m, t);
        const std::array<dvec3, 3> c{corners[0], corners[1], corners[2]};
        const dvec3 twice = glm::cross(c[1] - c[0], c[2] - c[0]);
        sum += 0.5 * twice;
        area += 0.5 * glm::length(twice);
        made.volume += glm::dot(c[0] - middle, twice) / 6;
    }
    made.open_share = area > 0 ? glm::length(sum) / area : 0;
    return made;
}

void mend_glass(imported_scene& s, const std::string& file, bool as_it_is)
{
    mender of(s, file, as_it_is);
    for (std::size_t i = 0; i < s.scene.meshes.size(); ++i)
        if (refracts(s.scene.materials, s.scene.materials[s.scene.meshes[i].material]))
            of.mend(i);
}

} // namespace photongrid
