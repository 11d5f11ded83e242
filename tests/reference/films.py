"""Films read back."""

import re
import subprocess

import imageio_ffmpeg
import numpy as np
from PIL import Image


def frames_of(path):
    """The frames of a film, how many and of what size."""
    if path.suffix == ".mp4":
        command = [imageio_ffmpeg.get_ffmpeg_exe(), "-i", str(path), "-f", "rawvideo", "-pix_fmt", "rgb24", "-"]
        run = subprocess.run(command, capture_output=True, check=True)
        about = re.search(rb"h264.*yuv420p.* (\d+)x(\d+).* ([\d.]+) fps", run.stderr)
        width, height = int(about[1]), int(about[2])
        return list(np.frombuffer(run.stdout, np.uint8).reshape(-1, height, width, 3)), float(about[3])
    with Image.open(path) as film:
        frames, delays = [], []
        for k in range(film.n_frames):
            film.seek(k)
            delays.append(film.info["duration"])
            frames.append(np.asarray(film.convert("RGB")))
    return frames, 1000 * len(delays) / sum(delays)
