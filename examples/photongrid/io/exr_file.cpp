#include <photongrid/io/image_formats.hpp>

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <stdexcept>
#include <vector>

namespace photongrid::image_formats {

namespace {
    class memory_stream : public Imf::OStream {
    public:
        memory_stream() : Imf::OStream("memory") {}
        void write(const char c[], int n) override
        {
            const auto size = static_cast<std::size_t>(n);
            if (at_ + size > bytes.size())
                bytes.resize(at_ + size);
            std::memcpy(bytes.data() + at_, c, size);
            at_ += size;
        }
        std::uint64_t tellp() override { return at_; }
        void seekp(std::uint64_t at) override { at_ = static_cast<std::size_t>(at); }
        std::string bytes;

    private:
        std::size_t at_ = 0;
    };

    /// The channels of an RGB float picture whose first pixel has the box's smallest coordinates.
    Imf::FrameBuffer rgb_frame(glm::vec3* pixels, const Imath::Box2i& box)
    {
        const auto width = static_cast<std::size_t>(box.max.x - box.min.x) + 1;
        Imf::FrameBuffer frame;
        for (int c = 0; c < 3; ++c)
            frame.insert(std::string(1, "RGB"[c]),
                Imf::Slice::Make(Imf::FLOAT, &(*pixels)[c], box, sizeof(glm::vec3), sizeof(glm::vec3) * width));
        return frame;
    }

    /// A layer and the name of its channel.
    struct layer_channel {
        const char* name;
        const std::vector<float>& values;
    };

    /// The layers of a picture that are not empty.
    std::vector<layer_channel> layers_of(const image& picture)
    {
        const auto& l = picture.layers;
        std::vector<layer_channel> all;
        for (const auto& c : {layer_channel{"estimate.radius", l.radius}, layer_channel{"estimate.count", l.count},
                 layer_channel{"estimate.relative_error", l.relative_error}, layer_channel{"noise", l.noise},
                 layer_channel{"bias", l.bias}})
            if (!c.values.empty())
                all.push_back(c);
        return all;
    }
} // namespace

std::string exr_bytes(const image& picture, const image_notes& notes)
{
    Imf::Header header(static_cast<int>(picture.width), static_cast<int>(picture.height));
    for (const auto* c : {"R", "G", "B"})
        header.channels().insert(c, Imf::Channel(Imf::FLOAT));
    const auto layers = layers_of(picture);
    for (const auto& l : layers) {
        if (l.values.size() != picture.pixels.size())
            throw std::runtime_error(std::string("the layer ") + l.name + " has " + std::to_string(l.values.size())
                + " values for " + std::to_string(picture.pixels.size()) + " pixels");
        header.channels().insert(l.name, Imf::Channel(Imf::FLOAT));
    }
    header.compression() = Imf::ZIP_COMPRESSION;
    for (const auto& [name, text] : notes)
        header.insert(name, Imf::StringAttribute(text));
    memory_stream stream;
    {
        Imf::OutputFile file(stream, header);
        // OpenEXR needs non-const pointers for reading.
        auto frame = rgb_frame(const_cast<glm::vec3*>(picture.pixels.data()), header.dataWindow());
        for (const auto& l : layers)
            frame.insert(
                l.name, Imf::Slice::Make(Imf::FLOAT, const_cast<float*>(l.values.data()), header.dataWindow()));
        file.setFrameBuffer(frame);
        file.writePixels(static_cast<int>(picture.height));
    }
    return std::move(stream.bytes);
}

namespace {
    class memory_source : public Imf::IStream {
    public:
        explicit memory_source(std::string_view bytes) : Imf::IStream("memory"), bytes_(bytes) {}
        bool read(char to[], int n) override
        {
            const auto size = static_cast<std::size_t>(n);
            if (at_ > bytes_.size() || size > bytes_.size() - at_)
                throw std::runtime_error("the file ends within the picture");
            std::copy_n(bytes_.data() + at_, size, to);
            at_ += size;
            return at_ < bytes_.size();
        }
        std::uint64_t tellg() override { return at_; }
        void seekg(std::uint64_t at) override { at_ = static_cast<std::size_t>(at); }

    private:
        std::string_view bytes_;
        std::size_t at_ = 0;
    };

    /// The names of its red, green and blue: R, G and B, those of its first layer that has them, or Y for all.
    std::array<std::string, 3> names_of_colours(const Imf::ChannelList& channels)
    {
        const auto has = [&](const std::string& layer) {
            return channels.findChannel(layer + "R") != nullptr && channels.findChannel(layer + "G") != nullptr
                && channels.findChannel(layer + "B") != nullptr;
        };
        if (has(""))
            return {"R", "G", "B"};
        for (auto c = channels.begin(); c != channels.end(); ++c) {
            const std::string name = c.name();
            if (const auto layer = name.substr(0, name.rfind('.') + 1); !layer.empty() && has(layer))
                return {layer + "R", layer + "G", layer + "B"};
        }
        if (channels.findChannel("Y") != nullptr)
            return {"Y", "Y", "Y"};
        throw std::runtime_error("it has neither the channels R, G and B nor Y");
    }
} // namespace

void decode_exr(std::string_view bytes, picture_sink& to)
{
    // A file's header may claim tiles and rows that take all memory.
    Imf::Header::setMaxImageSize(max_picture_edge, max_picture_edge);
    Imf::Header::setMaxTileSize(8192, 8192);
    memory_source source(bytes);
    Imf::InputFile file(source, 0); // no threads
    const auto& header = file.header();
    const auto shown = header.displayWindow(), box = header.dataWindow();
    const auto side = [](int low, int high) { return std::int64_t{high} - low + 1; };
    std::uint32_t channels = 0;
    for (auto c = header.channels().begin(); c != header.channels().end(); ++c)
        ++channels;
    const auto names = names_of_colours(header.channels());
    for (const auto& name : names)
        if (const auto& c = header.channels()[name]; c.xSampling != 1 || c.ySampling != 1)
            throw std::runtime_error("its channel " + name + " has not a value for each pixel");
    const std::int64_t width = side(shown.min.x, shown.max.x), height = side(shown.min.y, shown.max.y);
    if (width < 1 || height < 1 || width > max_picture_edge || height > max_picture_edge)
        throw std::runtime_error("it is " + std::to_string(width) + " x " + std::to_string(height) + " pixels");
    // The window that it has values for may be another; what is outside is black.
    to.begin({.width = static_cast<std::uint32_t>(width),
        .height = static_cast<std::uint32_t>(height),
        .channels = std::max(channels, 4u)
            * static_cast<std::uint32_t>(std::max<std::int64_t>(side(box.min.x, box.max.x) / width, 1))});
    std::vector<glm::vec3> held(static_cast<std::size_t>(side(box.min.x, box.max.x)));
    std::vector<glm::vec4> row(static_cast<std::size_t>(width));
    for (int y = shown.min.y; y <= shown.max.y; ++y) {
        std::fill(row.begin(), row.end(), glm::vec4(0, 0, 0, 1));
        if (y >= box.min.y && y <= box.max.y) {
            const Imath::Box2i line({box.min.x, y}, {box.max.x, y});
            Imf::FrameBuffer frame;
            const auto add = [&](int c) {
                frame.insert(names[static_cast<std::size_t>(c)],
                    Imf::Slice::Make(
                        Imf::FLOAT, &held[0][c], line, sizeof(glm::vec3), sizeof(glm::vec3) * held.size()));
            };
            add(0);
            for (int c = 1; c < 3 && names[1] != names[0]; ++c)
                add(c);
            file.setFrameBuffer(frame);
            file.readPixels(y);
            for (int x = std::max(shown.min.x, box.min.x); x <= std::min(shown.max.x, box.max.x); ++x) {
                const auto& p = held[static_cast<std::size_t>(x - box.min.x)];
                row[static_cast<std::size_t>(x - shown.min.x)]
                    = names[1] != names[0] ? glm::vec4(p, 1) : glm::vec4(p.x, p.x, p.x, 1);
            }
        }
        to.row(static_cast<std::uint32_t>(y - shown.min.y), row);
    }
}

} // namespace photongrid::image_formats
