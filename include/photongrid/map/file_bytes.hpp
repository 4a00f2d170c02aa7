// The bytes of a file, which the system maps into memory if it can.
#pragma once

#include <photongrid/map/map_file_format.hpp>

#include <cerrno>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <system_error>
#include <vector>

#if __has_include(<sys/mman.h>)
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>
#define PHOTONGRID_CAN_MAP_FILES
#endif

namespace photongrid::detail {

/// The bytes of a file, in memory.
class file_bytes {
public:
    explicit file_bytes(const std::filesystem::path& file)
    {
#if defined(PHOTONGRID_CAN_MAP_FILES)
        const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
        if (descriptor < 0)
            throw map_file_error(file, "cannot be opened: " + std::generic_category().message(errno));
        struct ::stat status {};
        const bool known = ::fstat(descriptor, &status) == 0 && S_ISREG(status.st_mode);
        if (known && status.st_size > 0)
            mapped_ = ::mmap(nullptr, static_cast<std::size_t>(status.st_size), PROT_READ, MAP_PRIVATE, descriptor, 0);
        ::close(descriptor);
        if (!known || mapped_ == MAP_FAILED) {
            mapped_ = nullptr;
            throw map_file_error(file, known ? "cannot be mapped into memory" : "is not a regular file");
        }
        size_ = static_cast<std::size_t>(status.st_size);
#else
        std::ifstream in(file, std::ios::binary | std::ios::ate);
        if (!in)
            throw map_file_error(file, "cannot be opened");
        size_ = static_cast<std::size_t>(in.tellg());
        // In aligned lines of 64 bytes, so that buffers are aligned for their types.
        read_.resize((size_ + 63) / 64);
        in.seekg(0);
        if (!in.read(reinterpret_cast<char*>(read_.data()), static_cast<std::streamsize>(size_)))
            throw map_file_error(file, "cannot be read");
#endif
    }
    file_bytes(const file_bytes&) = delete;
    file_bytes& operator=(const file_bytes&) = delete;
    ~file_bytes()
    {
#if defined(PHOTONGRID_CAN_MAP_FILES)
        if (mapped_ != nullptr)
            ::munmap(mapped_, size_);
#endif
    }
    std::size_t size() const { return size_; }
    const std::byte* data() const
    {
#if defined(PHOTONGRID_CAN_MAP_FILES)
        return static_cast<const std::byte*>(mapped_);
#else
        return reinterpret_cast<const std::byte*>(read_.data());
#endif
    }

private:
    std::size_t size_ = 0;
#if defined(PHOTONGRID_CAN_MAP_FILES)
    void* mapped_ = nullptr;
#else
    struct alignas(64) line {
        std::byte bytes[64];
    };
    std::vector<line> read_;
#endif
};

} // namespace photongrid::detail
#undef PHOTONGRID_CAN_MAP_FILES
