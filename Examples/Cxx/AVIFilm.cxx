// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "AVIFilm.h"

#include "ProgressLine.h"

extern "C"
{
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/opt.h>
}

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <new>
#include <stdexcept>

namespace
{
struct Free
{
  void operator()(AVFormatContext* format) const
  {
    avio_closep(&format->pb);
    avformat_free_context(format);
  }
  void operator()(AVCodecContext* encoder) const { avcodec_free_context(&encoder); }
  void operator()(AVFrame* frame) const { av_frame_free(&frame); }
  void operator()(AVPacket* packet) const { av_packet_free(&packet); }
};

template <typename T>
using Owned = std::unique_ptr<T, Free>;

template <typename T>
Owned<T> Own(T* made)
{
  if (!made)
  {
    throw std::bad_alloc();
  }
  return Owned<T>(made);
}

/// Y, Cb and Cr as in JFIF: from 0 to 255.
Palette ToYCbCr(const Palette& palette)
{
  Palette found;
  std::transform(palette.begin(), palette.end(), found.begin(),
    [](const std::array<unsigned char, 3>& c)
    {
      const double y = 0.299 * c[0] + 0.587 * c[1] + 0.114 * c[2];
      const double values[3] = { y, 128.0 + (c[2] - y) / 1.772, 128.0 + (c[0] - y) / 1.402 };
      std::array<unsigned char, 3> bytes;
      std::transform(values, values + 3, bytes.begin(),
        [](double value)
        { return static_cast<unsigned char>(std::min(std::lround(value), 255L)); });
      return bytes;
    });
  return found;
}

/// Motion JPEG in AVI, the palette's colours.
class AVIFile
{
public:
  AVIFile(const std::string& path, const int size[2], const Palette& palette, int rate)
    : Path(path),
      Size{ size[0], size[1] },
      Colors(ToYCbCr(palette))
  {
    av_log_set_level(AV_LOG_QUIET); // a failure is one sentence
    this->OpenEncoder(rate);
    this->MakeFrame();
    this->OpenFile();
  }

  /// Bottom row first.
  void Add(const unsigned char* pixels)
  {
    this->Check(av_frame_make_writable(this->Frame.get()));
    this->PaintLuma(pixels);
    this->PaintChroma(pixels);
    this->Check(avcodec_send_frame(this->Encoder.get(), this->Frame.get()));
    ++this->Frame->pts;
    this->WritePackets();
  }

  void Close()
  {
    this->Check(avcodec_send_frame(this->Encoder.get(), nullptr));
    this->WritePackets();
    this->Check(av_write_trailer(this->Format.get()));
    this->Check(avio_closep(&this->Format->pb));
  }

private:
  void OpenEncoder(int rate)
  {
    const AVCodec* const codec = avcodec_find_encoder(AV_CODEC_ID_MJPEG);
    if (!codec)
    {
      throw std::runtime_error("this libavcodec has no Motion JPEG to write .avi with: take .png.");
    }
    this->Encoder = Own(avcodec_alloc_context3(codec));
    AVCodecContext& encoder = *this->Encoder;
    encoder.width = this->Size[0];
    encoder.height = this->Size[1];
    encoder.time_base = { 1, rate };
    encoder.framerate = { rate, 1 };
    encoder.sample_aspect_ratio = { 1, 1 };
    // 4:2:0, as 4:2:2 and 4:4:4 get sampling factors from libavcodec that not every player knows.
    encoder.pix_fmt = AV_PIX_FMT_YUV420P;
    encoder.color_range = AVCOL_RANGE_JPEG;
    encoder.flags |= AV_CODEC_FLAG_QSCALE;
    encoder.qmin = 1; // the finest
    encoder.global_quality = FF_QP2LAMBDA;
    // Players may take the tables of the JPEG standard for granted.
    this->Check(av_opt_set(encoder.priv_data, "huffman", "default", 0));
    this->Check(avcodec_open2(&encoder, codec, nullptr));
  }

  void MakeFrame()
  {
    this->Frame->format = this->Encoder->pix_fmt;
    this->Frame->color_range = this->Encoder->color_range;
    this->Frame->width = this->Size[0];
    this->Frame->height = this->Size[1];
    this->Frame->quality = this->Encoder->global_quality;
    this->Frame->pts = 0;
    this->Check(av_frame_get_buffer(this->Frame.get(), 0));
  }

  void OpenFile()
  {
    AVFormatContext* format = nullptr;
    this->Check(avformat_alloc_output_context2(&format, nullptr, "avi", this->Path.c_str()));
    this->Format = Own(format);
    AVStream* const stream = avformat_new_stream(format, nullptr);
    if (!stream)
    {
      throw std::bad_alloc();
    }
    stream->time_base = this->Encoder->time_base;
    stream->avg_frame_rate = this->Encoder->framerate;
    stream->sample_aspect_ratio = this->Encoder->sample_aspect_ratio;
    this->Check(avcodec_parameters_from_context(stream->codecpar, this->Encoder.get()));
    this->Check(avio_open(&format->pb, this->Path.c_str(), AVIO_FLAG_WRITE));
    this->Check(avformat_write_header(format, nullptr));
  }

  const unsigned char* GetRow(const unsigned char* pixels, int fromTop) const
  {
    return pixels + std::ptrdiff_t(this->Size[1] - 1 - fromTop) * this->Size[0];
  }

  void PaintLuma(const unsigned char* pixels)
  {
    for (int y = 0; y < this->Size[1]; ++y)
    {
      const unsigned char* const row = this->GetRow(pixels, y);
      std::transform(row, row + this->Size[0],
        this->Frame->data[0] + std::ptrdiff_t(y) * this->Frame->linesize[0],
        [this](unsigned char place) { return this->Colors[place][0]; });
    }
  }

  /// The mean of two by two pixels; the last of an odd number counts twice.
  void PaintChroma(const unsigned char* pixels)
  {
    for (int y = 0; y < this->Size[1]; y += 2)
    {
      const unsigned char* const rows[2] = { this->GetRow(pixels, y),
        this->GetRow(pixels, std::min(y + 1, this->Size[1] - 1)) };
      for (int x = 0; x < this->Size[0]; x += 2)
      {
        const int next = std::min(x + 1, this->Size[0] - 1);
        for (int c = 1; c < 3; ++c)
        {
          const int sum = this->Colors[rows[0][x]][c] + this->Colors[rows[0][next]][c] +
            this->Colors[rows[1][x]][c] + this->Colors[rows[1][next]][c];
          this->Frame->data[c][std::ptrdiff_t(y / 2) * this->Frame->linesize[c] + x / 2] =
            static_cast<unsigned char>((sum + 2) / 4);
        }
      }
    }
  }

  void WritePackets()
  {
    int result;
    while ((result = avcodec_receive_packet(this->Encoder.get(), this->Packet.get())) >= 0)
    {
      av_packet_rescale_ts(
        this->Packet.get(), this->Encoder->time_base, this->Format->streams[0]->time_base);
      this->Check(av_write_frame(this->Format.get(), this->Packet.get()));
      av_packet_unref(this->Packet.get());
    }
    if (result != AVERROR(EAGAIN) && result != AVERROR_EOF)
    {
      this->Check(result);
    }
  }

  void Check(int result) const
  {
    if (result == AVERROR(ENOMEM))
    {
      throw std::bad_alloc();
    }
    if (result < 0)
    {
      throw CannotWrite(this->Path);
    }
  }

  std::string Path;
  int Size[2];
  Palette Colors;
  Owned<AVCodecContext> Encoder;
  Owned<AVFrame> Frame = Own(av_frame_alloc());
  Owned<AVPacket> Packet = Own(av_packet_alloc());
  Owned<AVFormatContext> Format;
};
}

void WriteAVI(vtkImageData* slices, const Palette& palette, const FilmSettings& settings,
  const std::string& path)
{
  AVIFile file(path, slices->GetDimensions(), palette, settings.Rate);
  const int count = slices->GetDimensions()[2];
  ProgressLine line("writing");
  for (int n = 0; n < count; ++n)
  {
    line.Show(double(n) / count);
    file.Add(static_cast<unsigned char*>(slices->GetScalarPointer(0, 0, n)));
  }
  file.Close();
}
