#include <photongrid/io/image_formats.hpp>

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>

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

image read_exr(const std::string& path)
{
    Imf::InputFile file(path.c_str());
    const auto box = file.header().dataWindow();
    const auto width = std::int64_t{box.max.x} - box.min.x + 1, height = std::int64_t{box.max.y} - box.min.y + 1;
    check_read_size(path, width, height);
    for (const auto* c : {"R", "G", "B"})
        if (!file.header().channels().findChannel(c))
            fail_file(path, std::string("has no channel ") + c + "; expected R, G and B");
    image picture{.width = static_cast<std::uint32_t>(width),
        .height = static_cast<std::uint32_t>(height),
        .pixels = std::vector<glm::vec3>(static_cast<std::size_t>(width * height))};
    file.setFrameBuffer(rgb_frame(picture.pixels.data(), box));
    file.readPixels(box.min.y, box.max.y);
    return picture;
}

} // namespace photongrid::image_formats
