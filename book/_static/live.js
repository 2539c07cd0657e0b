// Figures to play with, in a chapter: as soon as one is near, the script of the playground is loaded, and mounts it.

(() => {
  const { bundle } = document.currentScript.dataset;
  let loading = null;

  function load() {
    loading ??= new Promise((resolve) => {
      const script = document.createElement("script");
      script.src = bundle;
      script.onload = () => resolve(playground());
      document.head.append(script);
    });
    return loading;
  }

  const near = new IntersectionObserver((entries) => {
    for (const { isIntersecting, target } of entries) {
      if (!isIntersecting) continue;
      near.unobserve(target);
      load().then(({ mountFigure, makeWorker }) =>
        mountFigure(target, { ...JSON.parse(target.dataset.figure), makeWorker })
      );
    }
  }, { rootMargin: "50% 0px" });
  for (const element of document.querySelectorAll(".live")) near.observe(element);
})();
