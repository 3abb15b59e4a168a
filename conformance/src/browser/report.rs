//! What holds for every report of `ambray compare`, whatever it is about, in a real browser.

use super::Page;

/// Tries everything on the page that can be moved, and looks at everything that can be seen.
///
/// # Panics
/// If something does not hold.
pub fn check(page: &mut Page) {
    fits_the_window(page);
    pictures_are_drawn(page);
    sliders_move(page);
    plots_are_drawn(page);
    tables_can_be_sorted(page);
    assert_clean(page);
}

/// Nothing was said on the console, and nothing asked for outside the page.
///
/// # Panics
/// If something was.
pub fn assert_clean(page: &mut Page) {
    let complaints = page.complaints();
    assert!(complaints.is_empty(), "the browser complains:\n{}", complaints.join("\n"));
}

/// The page itself is not wider than the window; wide tables scroll within it.
fn fits_the_window(page: &mut Page) {
    let [width, window] =
        ["document.documentElement.scrollWidth", "innerWidth"].map(|expression| page.number(expression));
    assert!(width <= window, "the page is {width} wide in a window of {window}");
}

/// Every embedded picture can be decoded and has the size that the page says.
fn pictures_are_drawn(page: &mut Page) {
    let wrong = page.value(
        "Promise.all([...document.querySelectorAll('.store image')].map(async element => {
            const image = new Image();
            image.src = element.getAttribute('href');
            await image.decode().catch(() => {});
            const says = [element.getAttribute('width'), element.getAttribute('height')].join();
            const is = [image.naturalWidth, image.naturalHeight].join();
            return says === is ? '' : `${element.id} is ${is}, the page says ${says}`;
        })).then(all => all.filter(Boolean))",
    );
    assert_eq!(wrong.as_array().map(Vec::len), Some(0), "{wrong}");
    let hidden = page.value(
        "[...document.querySelectorAll('svg.picture')].filter(svg => {
            const box = svg.getBoundingClientRect();
            const target = document.querySelector(svg.firstElementChild.getAttribute('href'));
            return !target || box.width < 20 || box.height < 5;
        }).map(svg => svg.outerHTML)",
    );
    assert_eq!(hidden.as_array().map(Vec::len), Some(0), "pictures that cannot be seen: {hidden}");
}

/// Each divider follows the mouse, and the right picture begins there.
fn sliders_move(page: &mut Page) {
    let count = page.number("document.querySelectorAll('.slider').length") as usize;
    for i in 0..count {
        page.value(&format!("document.querySelectorAll('.slider')[{i}].setAttribute('data-tried', '')"));
        let stage = page.find("[data-tried] .stage");
        for target in [0.25, 0.8] {
            let from = page.number("document.querySelector('[data-tried] .divider').ariaValueNow / 100");
            page.drag(stage.at(from, 0.4), stage.at(target, 0.4));
            let clip =
                page.text("getComputedStyle(document.querySelector('[data-tried] .picture.right')).clipPath");
            let inset =
                clip.rsplit(' ').next().and_then(|last| last.trim_end_matches("%)").parse::<f64>().ok());
            let inset = inset.unwrap_or_else(|| panic!("{clip} is no inset in percent"));
            assert!((inset / 100.0 - target).abs() < 0.02, "slider {i} dragged to {target}: {clip}");
        }
        page.value("document.querySelector('[data-tried]').removeAttribute('data-tried')");
    }
}

/// Every plot is large enough to be read, and its points lie within it.
fn plots_are_drawn(page: &mut Page) {
    let wrong = page.value(
        "[...document.querySelectorAll('.chart')].flatMap(chart => {
            const box = chart.getBoundingClientRect();
            const frame = chart.querySelector('.frame').getBoundingClientRect();
            const inside = mark => {
                const { left, right, top, bottom } = mark.getBoundingClientRect();
                const [x, y] = [(left + right) / 2, (top + bottom) / 2];
                return x >= frame.left && x <= frame.right && y >= frame.top && y <= frame.bottom;
            };
            const marks = [...chart.querySelectorAll('.point .mark')];
            const cut = [...chart.querySelectorAll('text')].filter(text => {
                const inner = text.getBoundingClientRect();
                return inner.left < box.left - 1 || inner.right > box.right + 1 || inner.bottom > box.bottom + 1;
            });
            const faults = [];
            if (box.width < 250 || box.height < 150) faults.push(`${box.width} × ${box.height}`);
            if (marks.length === 0 || !marks.every(inside)) faults.push('points outside');
            if (chart.querySelectorAll('.grid text').length < 4) faults.push('no labels on the axes');
            const colour = (element) => getComputedStyle(element).getPropertyValue('--colour');
            const legend = [...chart.parentElement.querySelectorAll('.legend button')];
            const alike = legend.every(button => {
                const curve = chart.querySelector(`.series[data-series=\"${button.dataset.series}\"]`);
                const swatch = colour(button.querySelector('.swatch'));
                return swatch && swatch === colour(curve);
            });
            if (!alike) faults.push('the legend has other colours');
            if (cut.length) faults.push('cut: ' + cut.map(text => text.textContent));
            return faults.map(fault => `${chart.ariaLabel}: ${fault}`);
        })",
    );
    assert_eq!(wrong.as_array().map(Vec::len), Some(0), "{wrong}");
}

/// A click on each heading sorts the numbers of its column.
fn tables_can_be_sorted(page: &mut Page) {
    let wrong = page.value(
        "[...document.querySelectorAll('table.sortable')].flatMap(table =>
            [...table.tHead.rows[0].cells].flatMap((heading, column) => {
                heading.querySelector('button').click();
                const cells = [...table.tBodies[0].rows].map(row => row.cells[column]);
                const texts = cells.map(cell => cell.dataset.value).filter(value => value !== undefined);
                let values = texts.map(text => Number(text.replace('inf', 'Infinity'))).filter(v => !isNaN(v));
                if (heading.dataset.by === 'size') values = values.map(Math.abs);
                const sign = heading.ariaSort === 'descending' ? -1 : 1;
                const sorted = heading.ariaSort !== 'none'
                    && values.every((value, i) => i === 0 || sign * (value - values[i - 1] || 0) >= 0);
                return sorted ? [] : [`${heading.textContent}: ${values}`];
            }))",
    );
    assert_eq!(wrong.as_array().map(Vec::len), Some(0), "columns that are not sorted: {wrong}");
}
