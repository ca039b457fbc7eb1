import java.io.File;
import java.io.IOException;
import java.util.List;
import java.util.stream.Collectors;
import org.eclipse.emf.common.util.Diagnostic;
import org.eclipse.emf.common.util.URI;
import org.eclipse.emf.common.util.WrappedException;
import org.eclipse.emf.ecore.EObject;
import org.eclipse.emf.ecore.EPackage;
import org.eclipse.emf.ecore.resource.Resource;
import org.eclipse.emf.ecore.resource.ResourceSet;
import org.eclipse.emf.ecore.resource.impl.ResourceSetImpl;
import org.eclipse.emf.ecore.util.Diagnostician;
import org.eclipse.emf.ecore.util.EcoreUtil;
import org.eclipse.emf.ecore.xmi.impl.EcoreResourceFactoryImpl;
import org.eclipse.emf.ecore.xmi.impl.XMIResourceFactoryImpl;

/**
 * Lets Eclipse's own EMF read and validate metamodels and models, as a second opinion on our writer.
 *
 * <p>Exit code: 0 without a diagnostic, 1 with any, 2 for wrong usage.
 */
public final class EmfCheck {
  /** Names objects by their path in their file; the default is a Java object identity. */
  private static final Diagnostician READABLE =
      new Diagnostician() {
        @Override
        public String getObjectLabel(EObject object) {
          URI uri = EcoreUtil.getURI(object);
          // Of a dangling proxy the file matters too.
          return object.eIsProxy() ? uri.toString() : uri.fragment();
        }
      };

  /** One set for all files, so that an href to a file yields the objects already loaded from it. */
  private final ResourceSet files = new ResourceSetImpl();

  private int diagnostics = 0;

  private EmfCheck() {
    var factories = files.getResourceFactoryRegistry().getExtensionToFactoryMap();
    factories.put("ecore", new EcoreResourceFactoryImpl());
    factories.put(Resource.Factory.Registry.DEFAULT_EXTENSION, new XMIResourceFactoryImpl());
  }

  public static void main(String[] args) throws IOException {
    List<String> names = List.of(args);
    int separator = names.contains("--") ? names.indexOf("--") : names.size();
    List<String> ecores = names.subList(0, separator);
    List<String> models = names.stream().skip(separator + 1).toList();
    if (ecores.isEmpty()) {
      System.err.println("usage: EmfCheck ECORE... [-- XMI...]");
      System.exit(2);
    }

    EmfCheck check = new EmfCheck();
    for (String ecore : ecores) {
      for (EObject root : check.load(ecore).getContents()) {
        check.register(root);
      }
    }
    for (String model : models) {
      check.load(model);
    }
    // Only now: while loading, an ecore may refer to a package that is registered after it.
    EcoreUtil.resolveAll(check.files);
    // Not only the files asked for: what they refer to has been loaded as well. Indexed, since
    // validation may load more.
    for (int i = 0; i < check.files.getResources().size(); i++) {
      check.validate(check.files.getResources().get(i));
    }

    System.out.printf(
        "%d files, %d diagnostics%n", check.files.getResources().size(), check.diagnostics);
    System.exit(check.diagnostics == 0 ? 0 : 1);
  }

  private Resource load(String name) throws IOException {
    // Canonical, or one file under two names would be loaded as two packages.
    URI uri = URI.createFileURI(new File(name).getCanonicalPath());
    try {
      return files.getResource(uri, true);
    } catch (WrappedException e) {
      // The set keeps the resource, with its errors: validate() reports them.
      return files.getResource(uri, false);
    }
  }

  /** Makes a package and those inside it known by nsURI, as a generated package would be. */
  private void register(EObject root) {
    if (root instanceof EPackage pkg) {
      Object other = files.getPackageRegistry().put(pkg.getNsURI(), pkg);
      if (other != null && other != pkg) {
        report(pkg.eResource(), "nsURI '" + pkg.getNsURI() + "' belongs to another package already");
      }
      pkg.getESubpackages().forEach(this::register);
    }
  }

  /** Reports load errors, broken constraints and, since those count as such, dangling proxies. */
  private void validate(Resource file) {
    file.getErrors().forEach(e -> report(file, e.getMessage()));
    file.getWarnings().forEach(w -> report(file, w.getMessage()));
    if (file.getContents().isEmpty() && file.getErrors().isEmpty()) {
      report(file, "the file has no content");
    }
    for (EObject root : file.getContents()) {
      // Ecore's own validator is registered for .ecore content, the generic one serves all else.
      for (Diagnostic diagnostic : READABLE.validate(root).getChildren()) {
        report(file, text(diagnostic));
      }
    }
  }

  /** A message with its causes: the upper one knows the place, the lower ones the reason. */
  private static String text(Diagnostic diagnostic) {
    if (diagnostic.getChildren().isEmpty()) {
      return diagnostic.getMessage();
    }
    return diagnostic.getChildren().stream()
        .map(EmfCheck::text)
        .collect(Collectors.joining("; ", diagnostic.getMessage() + ": ", ""));
  }

  private void report(Resource file, String message) {
    diagnostics++;
    System.out.println(file.getURI().toFileString() + ": " + message);
  }
}
