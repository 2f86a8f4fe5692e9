#include "boxwood/io/image.h"

#include <array>
#include <bit>
#include <cstring>
#include <memory>

#include <Imath/half.h>
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include "boxwood/io/file_bytes.h"
#include "boxwood/io/picture_check.h"
#include "boxwood/scene/srgb.h"

namespace boxwood::io {
namespace {

// OpenImageIO and OpenEXR shall work on the calling thread alone: no thread starts that nobody asked for.
// (Setting the library's own "threads" would do the contrary: it starts a pool in order to shrink it.)
template <class File>
void keep_to_this_thread(File& file) {
  static const bool is_done = OIIO::attribute("exr_threads", -1);
  (void)is_done;
  file.threads(1);
}

// The attribute of an .exr that holds a text of the program's own.
constexpr const char* kNoteName = "boxwood";

// A message on one line.
std::string one_line(std::string text) {
  while (!text.empty() && (text.back() == '\n' || text.back() == ' ')) text.pop_back();
  for (char& c : text)
    if (c == '\n' || c == '\r') c = ' ';
  return text.empty() ? "unknown reason" : text;
}

// 0 to 255, NaN as 0.
std::uint8_t to_byte(float x) {
  return static_cast<std::uint8_t>(255 * min(1.0f, max(0.0f, x)) + 0.5f);
}

bool is_alpha(const Image& image, int channel) {
  return image.channels == 4 && channel == 3;
}

void check_shape(const std::string& path, const Image& image) {
  const std::size_t values = std::size_t(max(0, image.width)) * max(0, image.height) * max(0, image.channels);
  if (image.width <= 0 || image.height <= 0 || image.channels <= 0 || image.pixels.size() != values)
    throw FileError(path, "",
                    "a picture of " + std::to_string(image.width) + " x " + std::to_string(image.height) +
                        " pixels with " + std::to_string(image.channels) + " channels and " +
                        std::to_string(image.pixels.size()) + " numbers cannot be written");
}

/// A picture file in memory that OpenImageIO has opened.
class PictureFile {
 public:
  PictureFile(std::string_view bytes, const std::string& name)
      : name_(name),
        format_(picture_format(bytes, name)),
        bytes_(checked_picture(bytes, name)),
        memory_(bytes_.data(), bytes_.size()) {
    // Keep colors as the file has them, not multiplied by alpha.
    OIIO::ImageSpec wishes;
    wishes.attribute("oiio:UnassociatedAlpha", 1);
    input_ = OIIO::ImageInput::create(format_.empty() ? "none" : format_);
    if (!input_)
      throw FileError(name, "", "is not a picture that can be read: " + one_line(OIIO::geterror()));
    keep_to_this_thread(*input_);
    OIIO::ImageSpec found;
    if (!input_->supports("ioproxy") || !input_->set_ioproxy(&memory_) ||
        !input_->open(format_, found, wishes))
      throw FileError(name, "", "is not a picture that can be read: " + one_line(input_->geterror()));

    const OIIO::ImageSpec& spec = input_->spec();
    check_picture_size(name, spec.width, spec.height, spec.nchannels, bytes.size());
    if (spec.depth > 1) throw FileError(name, "", "is a volume, not a picture");
  }

  const OIIO::ImageSpec& spec() const { return input_->spec(); }
  /// Files of whole numbers hold sRGB, files of floats hold linear light.
  bool is_srgb() const {
    return !spec().format.is_floating_point() && spec()["oiio:ColorSpace"].get() != "Linear";
  }

  /// All channels of a pixel one after another, each of its own kind.
  std::vector<char> read_native() {
    std::vector<char> values(std::size_t(spec().width) * spec().height * spec().pixel_bytes(true));
    if (!input_->read_image(0, 0, 0, spec().nchannels, OIIO::TypeDesc::UNKNOWN, values.data()))
      throw FileError(name_, "", "the picture is damaged: " + one_line(input_->geterror()));
    return values;
  }

  template <class T>
  std::vector<T> read(OIIO::TypeDesc type) {
    std::vector<T> values(std::size_t(spec().width) * spec().height * spec().nchannels);
    if (!input_->read_image(0, 0, 0, spec().nchannels, type, values.data()))
      throw FileError(name_, "", "the picture is damaged: " + one_line(input_->geterror()));
    return values;
  }

 private:
  const std::string& name_;
  const std::string format_;
  std::string bytes_;
  OIIO::Filesystem::IOMemReader memory_;
  std::unique_ptr<OIIO::ImageInput> input_;
};

Texture decode_texture(std::string_view bytes, const std::string& name) {
  PictureFile file(bytes, name);
  const int channels = file.spec().nchannels;
  Texture texture{name, file.spec().width, file.spec().height, {}, true};
  texture.texels.resize(std::size_t(texture.width) * texture.height);

  // Floats are encoded as sRGB, which spends the 8 bits where eyes see them.
  std::vector<std::uint8_t> values;
  if (file.is_srgb()) {
    values = file.read<std::uint8_t>(OIIO::TypeDesc::UINT8);
  } else {
    const std::vector<float> linear = file.read<float>(OIIO::TypeDesc::FLOAT);
    values.reserve(linear.size());
    for (std::size_t i = 0; i < linear.size(); ++i) {
      const bool is_alpha = (channels == 2 || channels >= 4) && int(i % channels) == (channels == 2 ? 1 : 3);
      values.push_back(to_byte(is_alpha ? linear[i] : srgb_from_linear(linear[i])));
    }
  }

  // One channel is grey, two are grey and alpha, three are RGB, more are RGB and alpha.
  for (std::size_t i = 0; i < texture.texels.size(); ++i) {
    const std::uint8_t* from = &values[i * channels];
    const bool is_grey = channels < 3;
    texture.texels[i] = {from[0], from[is_grey ? 0 : 1], from[is_grey ? 0 : 2],
                         channels == 2   ? from[1]
                         : channels >= 4 ? from[3]
                                         : std::uint8_t(255)};
  }
  return texture;
}

// OpenImageIO reports what is wrong by return values, but the codecs below it also throw.
template <class Body>
auto guarded(const std::string& name, const Body& body) {
  try {
    return body();
  } catch (const FileError&) {
    throw;
  } catch (const std::exception& error) {
    throw FileError(name, "", "the picture is damaged: " + one_line(error.what()));
  }
}

}  // namespace

// Half is enough for what eyes look at: light, colors, directions.
bool may_be_half(const std::string& channel) {
  return channel == "R" || channel == "G" || channel == "B" || channel == "A" || channel == "Y" ||
         channel.ends_with(".R") || channel.ends_with(".G") || channel.ends_with(".B") ||
         channel.starts_with("normal.");
}

// The channels of an .exr one after another, each of its own kind, and the words behind them.
struct ExrPixels {
  ExrPixels(const Image& image, const ExrOptions& exr, OIIO::ImageSpec& spec) {
    spec.channelnames = image.channel_names;
    for (const std::string& name : image.channel_names)
      spec.channelformats.push_back(exr.is_half && may_be_half(name) ? OIIO::TypeDesc::HALF
                                                                     : OIIO::TypeDesc::FLOAT);
    for (const std::string& name : exr.word_names) {
      spec.channelnames.push_back(name);
      spec.channelformats.push_back(OIIO::TypeDesc::UINT32);
    }
    spec.nchannels = static_cast<int>(spec.channelnames.size());

    const std::size_t pixels = std::size_t(image.width) * image.height, words = exr.word_names.size();
    bytes.reserve(pixels * spec.nchannels * 4);
    for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
      for (int c = 0; c < image.channels; ++c) {
        const float value = image.pixels[pixel * image.channels + c];
        if (spec.channelformats[c] == OIIO::TypeDesc::HALF)
          put(half(min(max(value, -HALF_MAX), HALF_MAX)));
        else
          put(value);
      }
      for (std::size_t w = 0; w < words; ++w) put(exr.words[pixel * words + w]);
    }
  }

  template <class T>
  void put(T value) {
    const char* first = reinterpret_cast<const char*>(&value);
    bytes.insert(bytes.end(), first, first + sizeof(T));
  }
  std::vector<char> bytes;
};

void write_image(const std::filesystem::path& path, const Image& image, const ExrOptions& exr,
                 Lasting lasting) {
  const std::string name = path.string(), extension = lower_extension(path);
  const bool is_png = extension == ".png";
  if (!is_png && extension != ".exr" && extension != ".hdr")
    throw FileError(name, "", "pictures are written as .png, .exr or .hdr, not as '" + extension + "'");
  check_shape(name, image);
  if (is_png && image.channels != 1 && image.channels != 3 && image.channels != 4)
    throw FileError(name, "", "a PNG has 1, 3 or 4 channels, not " + std::to_string(image.channels));
  if (extension == ".hdr" && image.channels != 3)
    throw FileError(name, "", "an HDR picture has 3 channels, not " + std::to_string(image.channels));

  OIIO::ImageSpec spec(image.width, image.height, image.channels,
                       is_png ? OIIO::TypeDesc::UINT8 : OIIO::TypeDesc::FLOAT);
  if (extension == ".exr" && image.channel_names.size() == std::size_t(image.channels))
    spec.channelnames = image.channel_names;
  spec.attribute("oiio:ColorSpace", is_png ? "sRGB" : "Linear");
  if (is_png) spec.attribute("oiio:UnassociatedAlpha", 1);
  // OpenImageIO puts the time of writing into an EXR unless one is given;
  // equal pictures are to be equal files.
  spec.attribute("DateTime", "1970:01:01 00:00:00");

  if (!exr.note.empty()) spec.attribute(kNoteName, exr.note);
  const bool is_mixed = extension == ".exr" && (exr.is_half || !exr.word_names.empty());
  if (is_mixed && image.channel_names.size() != std::size_t(image.channels))
    throw FileError(name, "", "channels of different kinds need names");
  std::vector<char> mixed;
  if (is_mixed) mixed = ExrPixels(image, exr, spec).bytes;

  // Encode into memory, so that a full disk meets one writer that knows how to clean up.
  std::vector<unsigned char> bytes;
  guarded(name, [&] {
    OIIO::Filesystem::IOVecOutput memory(bytes);
    const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create("x" + extension);
    if (!output) throw FileError(name, "", "cannot be encoded: " + one_line(OIIO::geterror()));
    keep_to_this_thread(*output);
    if (!output->supports("ioproxy"))
      throw FileError(name, "", "cannot be encoded: this OpenImageIO only writes to disk");
    output->set_ioproxy(&memory);
    bool is_written = output->open("x" + extension, spec);
    if (is_written && is_png) {
      std::vector<std::uint8_t> encoded(image.pixels.size());
      for (std::size_t i = 0; i < encoded.size(); ++i) {
        const float x = image.pixels[i];
        encoded[i] =
            to_byte(is_alpha(image, int(i % image.channels)) ? x : srgb_from_linear(min(1.0f, max(0.0f, x))));
      }
      is_written = output->write_image(OIIO::TypeDesc::UINT8, encoded.data());
    } else if (is_written && is_mixed) {
      is_written = output->write_image(OIIO::TypeDesc::UNKNOWN, mixed.data());
    } else if (is_written) {
      is_written = output->write_image(OIIO::TypeDesc::FLOAT, image.pixels.data());
    }
    if (!is_written || !output->close())
      throw FileError(name, "", "cannot be encoded: " + one_line(output->geterror()));
  });
  write_file(path, {reinterpret_cast<const char*>(bytes.data()), bytes.size()}, lasting);
}

Image read_image(const std::filesystem::path& path) {
  const std::string name = path.string(), bytes = read_file(path);
  return guarded(name, [&] {
    PictureFile file(bytes, name);
    Image image;
    image.width = file.spec().width;
    image.height = file.spec().height;
    image.channels = file.spec().nchannels;
    image.channel_names = file.spec().channelnames;
    image.pixels = file.read<float>(OIIO::TypeDesc::FLOAT);
    if (file.is_srgb())
      for (std::size_t i = 0; i < image.pixels.size(); ++i)
        if (int(i % image.channels) != file.spec().alpha_channel)
          image.pixels[i] = linear_from_srgb(image.pixels[i]);
    return image;
  });
}

ExrFile read_exr(const std::filesystem::path& path) {
  const std::string name = path.string(), bytes = read_file(path);
  if (!std::string_view(bytes).starts_with("\x76\x2f\x31\x01"))
    throw FileError(name, "", "is not an OpenEXR file");
  return guarded(name, [&] {
    PictureFile file(bytes, name);
    const OIIO::ImageSpec& spec = file.spec();
    ExrFile found;
    found.note = std::string(spec.get_string_attribute(kNoteName));
    for (int c = 0; c < spec.nchannels; ++c)
      (spec.channelformat(c) == OIIO::TypeDesc::UINT32 ? found.word_names : found.image.channel_names)
          .push_back(spec.channelnames[c]);
    found.image.width = spec.width;
    found.image.height = spec.height;
    found.image.channels = static_cast<int>(found.image.channel_names.size());

    // Sort the values of each pixel by their kind.
    const std::vector<char> values = file.read_native();
    const char* at = values.data();
    const auto take = [&at](auto value) {
      std::memcpy(&value, at, sizeof(value));
      at += sizeof(value);
      return value;
    };
    const std::size_t pixels = std::size_t(spec.width) * spec.height;
    found.image.pixels.reserve(pixels * found.image.channels);
    found.words.reserve(pixels * found.word_names.size());
    for (std::size_t pixel = 0; pixel < pixels; ++pixel)
      for (int c = 0; c < spec.nchannels; ++c) {
        if (spec.channelformat(c) == OIIO::TypeDesc::UINT32)
          found.words.push_back(take(std::uint32_t{}));
        else
          found.image.pixels.push_back(spec.channelformat(c) == OIIO::TypeDesc::HALF ? float(take(half()))
                                                                                     : take(0.0f));
      }
    return found;
  });
}

Texture read_texture(const std::filesystem::path& path) {
  const std::string name = path.string(), bytes = read_file(path);
  return guarded(name, [&] { return decode_texture(bytes, name); });
}

Texture read_texture(std::span<const std::byte> bytes, const std::string& name) {
  return guarded(name, [&] {
    return decode_texture({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, name);
  });
}

}  // namespace boxwood::io
