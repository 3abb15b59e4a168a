"""Makes the pairs of maps of this folder and their measures, by implementations that are not ours.

    pip install numpy==2.4.6 scikit-image==0.26.0 flip-evaluator==1.7 && python make.py

RMSE, PSNR and SSIM are scikit-image's, FLIP is NVIDIA's, percentiles are NumPy's; the measures of spec section 10 are
written down here with NumPy, box means by an integral image and the pattern by a fast Fourier transform.
"""

import json
import pathlib

import flip_evaluator
import numpy as np
from skimage.metrics import mean_squared_error, peak_signal_noise_ratio, structural_similarity

HERE = pathlib.Path(__file__).parent
RANDOM = np.random.Generator(np.random.PCG64(20240607))
FLOAT = "<f4"


def scene(width, height):
    """Something like openness: a floor that darkens towards a wall, a round thing on it, a step."""
    y, x = np.mgrid[0:height, 0:width] / [[[height]], [[width]]]
    floor = 1 - 0.5 * np.exp(-6 * x)
    ball = 0.6 * np.exp(-(((x - 0.6) / 0.12) ** 2 + ((y - 0.55) / 0.16) ** 2))
    step = np.where((y < 0.3) & (x > 0.35), 0.25, 0.0)
    return np.clip(floor - ball - step, 0, 1)


def blurred(values):
    """Mean of 5 x 5, the border repeated."""
    padded = np.pad(values, 2, mode="edge")
    height, width = values.shape
    return sum(padded[dy:dy + height, dx:dx + width] for dy in range(5) for dx in range(5)) / 25


def noise(values, sigma):
    return np.clip(values + sigma * RANDOM.standard_normal(values.shape), 0, 1)


def tiled(values, strength):
    """An error that repeats every 4 x 4 pixels."""
    height, width = values.shape
    tile = RANDOM.uniform(-strength, strength, (4, 4))
    return np.clip(values + np.tile(tile, (height // 4 + 1, width // 4 + 1))[:height, :width], 0, 1)


def edges(reference):
    found = np.zeros(reference.shape, bool)
    for axis in (0, 1):
        steep = np.abs(np.diff(reference, axis=axis)) > np.float32(0.08)
        pad = [(0, 0), (0, 0)]
        for pad[axis] in ((0, 1), (1, 0)):
            found |= np.pad(steep, pad)
    return found


def box_mean(values, reach):
    height, width = values.shape
    integral = np.pad(values.cumsum(0).cumsum(1), ((1, 0), (1, 0)))
    y0, y1 = np.clip([np.arange(height) - reach, np.arange(height) + reach + 1], 0, height)
    x0, x1 = np.clip([np.arange(width) - reach, np.arange(width) + reach + 1], 0, width)
    sums = integral[np.ix_(y1, x1)] - integral[np.ix_(y0, x1)] - integral[np.ix_(y1, x0)] + integral[np.ix_(y0, x0)]
    return sums / np.outer(y1 - y0, x1 - x0)


def pattern_left(error):
    power = np.abs(np.fft.fft2(error)) ** 2
    height, width = power.shape
    offset = np.arange(-12, 13)
    ratios = []
    for l in range(4):
        for k in range(4):
            if (k, l) != (0, 0):
                rows, columns = (l * height // 4 + offset) % height, (k * width // 4 + offset) % width
                block = power[np.ix_(rows, columns)].copy()
                middle = block[12, 12]
                outside = np.ones((25, 25), bool)
                outside[10:15, 10:15] = False
                ratios.append(middle / block[outside].mean())
    return max(ratios)


def flip(reference, test):
    """Of the 8 bits that a screen shows."""
    byte = lambda v: np.floor(np.clip(v, 0, 1).astype(np.float32) * np.float32(255) + np.float32(0.5))
    shown = [byte(v) / np.float32(255) for v in (reference, test)]
    shown = [np.ascontiguousarray(v if v.ndim == 3 else np.stack([v] * 3, -1), np.float32) for v in shown]
    errors, _, _ = flip_evaluator.evaluate(
        *shown, "LDR", inputsRGB=True, applyMagma=False, computeMeanError=True, parameters={"ppd": 67})
    return float(np.asarray(errors, np.float64).mean())


def rms(values):
    return float(np.sqrt(np.mean(values**2)))


def measures(estimate, reference, filtered_reference=None):
    estimate, reference = estimate.astype(np.float64), reference.astype(np.float64)
    error = estimate - reference
    channels = {"channel_axis": 2} if error.ndim == 3 else {}
    planes = [reference[..., c] for c in range(3)] if channels else [reference]
    edge = np.any([edges(plane.astype(np.float32)) for plane in planes], axis=0)
    result = {
        "rmse": float(np.sqrt(mean_squared_error(estimate, reference))),
        "psnr": float(peak_signal_noise_ratio(reference, estimate, data_range=1)),
        "bias": float(error.mean()),
        "p99": float(np.percentile(np.abs(error), 99)),
        "max": float(np.abs(error).max()),
        "flip": flip(reference, estimate),
        "ssim": float(structural_similarity(estimate, reference, gaussian_weights=True, sigma=1.5,
                                            use_sample_covariance=False, data_range=1, **channels)),
        "edge-rmse": rms(error[edge]),
        "flat-rmse": rms(error[~edge]),
    }
    if filtered_reference is not None:
        filtered_reference = filtered_reference.astype(np.float64)
        left = estimate - filtered_reference
        result |= {
            "sampling-part": rms(left),
            "filter-loss": rms(filtered_reference - reference),
            "grain": rms(left - box_mean(left, 4)),
            "pattern-left": float(pattern_left(np.where(edge, 0, left))),
        }
    return result


def store(name, values):
    """As bytes: single precision, little-endian, channel after channel."""
    planes = np.moveaxis(values, -1, 0) if values.ndim == 3 else values
    planes.astype(FLOAT).tofile(HERE / f"{name}.f32")


def main():
    truth = scene(61, 43).astype(np.float32)
    wide = scene(64, 48).astype(np.float32)
    color = np.stack([scene(48, 40) ** gamma for gamma in (0.7, 1.0, 1.6)], -1).astype(np.float32)
    single = lambda values: values.astype(np.float32)
    maps = {
        "truth": truth,
        "truth.filtered": single(blurred(truth)),
        "wide": wide,
        "wide.filtered": single(blurred(wide)),
        "color": color,
    }
    pairs = {
        "noise": (noise(truth, 0.05), "truth", None),
        "shift": (truth * 0.93 + 0.01, "truth", None),
        "blur": (blurred(truth), "truth", None),
        "filtered": (blurred(noise(truth, 0.08)), "truth", "truth.filtered"),
        "tiled": (tiled(noise(wide, 0.02), 0.04), "wide", "wide.filtered"),
        "tinted": (noise(color, 0.06), "color", None),
    }
    for name, values in maps.items():
        store(name, values)
    values = []
    for name, (estimate, reference, filtered) in pairs.items():
        estimate = single(estimate)
        store(name, estimate)
        values.append({
            "estimate": name,
            "reference": reference,
            **({"filtered-reference": filtered} if filtered else {}),
            "width": estimate.shape[1],
            "channels": 3 if estimate.ndim == 3 else 1,
            "measures": measures(estimate, maps[reference], maps[filtered] if filtered else None),
        })
    (HERE / "values.json").write_text(json.dumps(values, indent=2) + "\n")


main()
